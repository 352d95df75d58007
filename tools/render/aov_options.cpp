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

constexpr const char* kShadow = "shadow";

void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected("--aov", got, expected));
}

// @param withShadow  whether the shadow on the ground, which is no Aov, is among them
std::vector<Aov> parseAovs(const std::string& option, const std::string& text, bool& withShadow) {
    std::vector<std::string> names;
    for (const Aov aov : allAovs()) names.push_back(aovName(aov));
    names.emplace_back(kShadow);
    std::vector<Aov> aovs;
    withShadow = false;
    for (const std::string& part : splitAt(text, ',')) {
        const auto found = std::find(names.begin(), names.end(), part);
        if (found == names.end()) {
            throw Error(ErrorCode::kUsage, gotExpected(option, text,
                                                       "some of " + joinWords(names, "and") +
                                                           ", with commas between"));
        }
        const auto number = std::size_t(found - names.begin());
        if (*found == kShadow) {
            withShadow = true;
        } else {
            aovs.push_back(allAovs()[number]);
        }
    }
    return aovs;
}

// Grids of layers that swallow light, but for the first, which is the volume.
std::vector<std::string> otherFogs(const MediumChoice& medium) {
    std::vector<std::string> grids;
    for (const LayerChoice& layer : medium.layers)
        if (!layer.transferFunction.empty()) grids.push_back(layer.grid);
    return grids;
}

}  // namespace

bool hasFront(const std::vector<Aov>& aovs) {
    return std::find(aovs.begin(), aovs.end(), Aov::kFront) != aovs.end();
}

void addAovOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    const Parser<std::vector<Aov>> parse = [&command](const std::string& option,
                                                      const std::string& text) {
        return parseAovs(option, text, command.withShadow);
    };
    group.addValue("--aov", "LIST", command.aovs, parse,
                   "Channels of an .exr beside its colours, with commas between: depth\n"
                   "(Z: mean depth of what is seen), front (depth_front.Z: where alpha\n"
                   "passes --depth-opacity), back (ZBack: of the last that is seen),\n"
                   "position (P.X, P.Y, P.Z: its mean place in the world), normal (N.X,\n"
                   "N.Y, N.Z: mean of its normals, likewise), emission (emission.R ...:\n"
                   "what shines by itself), ambient and direct (of --lighting scatter;\n"
                   "direct_1.R ... of each light, up to 8), transmittance, mattes\n"
                   "(matte_1 ...: share of alpha of each --layer that swallows light),\n"
                   "samples (slices that hide something of a pixel) and shadow\n"
                   "(shadow.R ...: the share of light lost on --ground). Each takes as\n"
                   "long as a picture or two; front, back and samples, together, about\n"
                   "half as long as --deep-slices 1");
    group.addValue("--depth-opacity", "A", command.aovOptions.depthOpacity,
                   number(kLeastDepthOpacity, 1),
                   withDefault("--aov front: alpha that is passed there, 0.001 to 1",
                               numberText(command.aovOptions.depthOpacity)));
}

void checkAovs(const RenderCommand& command) {
    if (command.aovs.empty() && !command.withShadow) return;
    if (!isExr(command)) refuse(command.output.string(), "an .exr file");
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (command.deep) refuse("--deep besides", "a flat picture, or --deep alone");
    const bool hasMattes =
        std::find(command.aovs.begin(), command.aovs.end(), Aov::kMattes) != command.aovs.end();
    if (hasMattes && otherFogs(command.picture.medium).empty())
        refuse("mattes of one volume", "several --layer that swallow light");
}

void warnOfUnusedAovOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display) {
    if (isGiven(app, "--depth-opacity") && !hasFront(command.aovs))
        display.warn("--depth-opacity: has no effect without --aov front");
}

std::vector<ImageChannel> withEmptyMattes(const MediumChoice& medium, const Optics& optics,
                                          std::vector<ImageChannel> channels) {
    std::vector<std::string> shown;
    for (const MediumPart& part : optics.parts) {
        if (part.kind == MediumPart::Kind::kAbsorption) shown.push_back(part.volume->name);
    }
    const std::vector<std::string> asked = otherFogs(medium);
    const auto isFirst = [](const ImageChannel& one) { return one.name == "matte_1"; };
    const auto first = std::find_if(channels.begin(), channels.end(), isFirst);
    if (first == channels.end() || asked.size() <= shown.size()) return channels;
    const std::size_t pixels = first->values.size();
    auto next = first + 1;
    for (std::size_t i = 0, found = 0; i < asked.size(); ++i) {
        const std::string name = "matte_" + std::to_string(i + 2);
        if (found < shown.size() && shown[found] == asked[i]) {
            next->name = name;
            ++found;
        } else {
            next = channels.insert(next, {name, std::vector<float>(pixels)});
        }
        ++next;
    }
    return channels;
}

void warnOfDepths(const std::vector<Aov>& aovs, const Optics& optics, const Listener& listener) {
    constexpr std::array kOfWhatHides{Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kPosition,
                                      Aov::kSamples};
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
