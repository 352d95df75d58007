// SPDX-License-Identifier: Apache-2.0
#include "render/aov_options.h"

#include <algorithm>
#include <array>
#include <string>

#include "deltasplat/error.h"
#include "number_text.h"
#include "options/parse.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected("--aov", got, expected));
}

std::vector<Aov> parseAovs(const std::string& option, const std::string& text) {
    std::vector<std::string> names;
    for (const Aov aov : allAovs()) names.push_back(aovName(aov));
    std::vector<Aov> aovs;
    for (const std::string& part : splitAt(text, ',')) {
        const auto found = std::find(names.begin(), names.end(), part);
        if (found == names.end()) {
            throw Error(ErrorCode::kUsage, gotExpected(option, text,
                                                       "some of " + joinWords(names, "and") +
                                                           ", with commas between"));
        }
        aovs.push_back(allAovs()[std::size_t(found - names.begin())]);
    }
    return aovs;
}

}  // namespace

bool hasFront(const std::vector<Aov>& aovs) {
    return std::find(aovs.begin(), aovs.end(), Aov::kFront) != aovs.end();
}

void addAovOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    group.addValue("--aov", "LIST", command.aovs, Parser<std::vector<Aov>>(parseAovs),
                   "Channels of an .exr beside its colours, with commas between: depth\n"
                   "(Z: mean depth of what is seen), front (depth_front.Z: where alpha\n"
                   "passes --depth-opacity), back (ZBack: of the last that is seen),\n"
                   "position (P.X, P.Y, P.Z: its mean place in the world), normal (N.X,\n"
                   "N.Y, N.Z: mean of its normals, likewise), emission (emission.R ...:\n"
                   "what shines by itself), ambient and direct (of --lighting scatter;\n"
                   "direct_1.R ... of each light, up to 8) and transmittance. Each takes as long "
                   "as a picture, front and back as long\n"
                   "as --deep-slices 1");
    group.addValue("--depth-opacity", "A", command.aovOptions.depthOpacity,
                   number(kLeastDepthOpacity, 1),
                   withDefault("--aov front: alpha that is passed there, 0.001 to 1",
                               numberText(command.aovOptions.depthOpacity)));
}

void checkAovs(const RenderCommand& command) {
    if (command.aovs.empty()) return;
    if (!isExr(command)) refuse(command.output.string(), "an .exr file");
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (command.deep) refuse("--deep besides", "a flat picture, or --deep alone");
}

void warnOfUnusedAovOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display) {
    if (isGiven(app, "--depth-opacity") && !hasFront(command.aovs))
        display.warn("--depth-opacity: has no effect without --aov front");
}

void warnOfDepths(const std::vector<Aov>& aovs, const Optics& optics, const Listener& listener) {
    constexpr std::array kOfWhatHides{Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kPosition};
    for (const Aov aov : aovs) {
        const bool isOfWhatHides =
            std::find(kOfWhatHides.begin(), kOfWhatHides.end(), aov) != kOfWhatHides.end();
        if (!isOfWhatHides || optics.parts.empty()) continue;
        listener.warn("--aov " + aovName(aov) +
                      ": is of what hides something; light of fire alone has none");
        return;
    }
}

}  // namespace deltasplat
