// SPDX-License-Identifier: Apache-2.0
#include "render/aov_options.h"

#include <algorithm>
#include <string>

#include "deltasplat/error.h"
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

void addAovOption(CLI::App& app, std::vector<Aov>& aovs) {
    OptionGroup group(app, "Output");
    group.addValue("--aov", "LIST", aovs, Parser<std::vector<Aov>>(parseAovs),
                   "Channels of an .exr beside its colours, with commas between: depth\n"
                   "(Z: mean depth of what is seen), position (P.X, P.Y, P.Z: its mean\n"
                   "place in the world), emission (emission.R ...: what shines by\n"
                   "itself), ambient and direct (of --lighting scatter; direct_1.R ... of\n"
                   "each light, up to 8) and transmittance. Each takes as long as a\n"
                   "picture");
}

void checkAovs(const RenderCommand& command) {
    if (command.aovs.empty()) return;
    if (!isExr(command)) refuse(command.output.string(), "an .exr file");
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (command.deep) refuse("--deep besides", "a flat picture, or --deep alone");
}

void warnOfDepths(const std::vector<Aov>& aovs, const Optics& optics, const Listener& listener) {
    for (const Aov aov : aovs) {
        if ((aov != Aov::kDepth && aov != Aov::kPosition) || optics.parts.empty()) continue;
        listener.warn("--aov " + aovName(aov) +
                      ": is of what hides something; light of fire alone has none");
        return;
    }
}

}  // namespace deltasplat
