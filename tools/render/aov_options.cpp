// SPDX-License-Identifier: Apache-2.0
#include "render/aov_options.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/parse.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

constexpr const char* kShadow = "shadow";

void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "--aov", got, expected);
}

ChannelChoice parseChannels(const std::string& option, const std::string& text) {
    std::vector<std::string> names;
    for (const Aov aov : allAovs()) names.push_back(aovName(aov));
    names.emplace_back(kShadow);
    ChannelChoice channels;
    for (const std::string& part : splitAt(text, ',')) {
        const auto number =
            std::size_t(std::find(names.begin(), names.end(), part) - names.begin());
        if (number == names.size()) {
            throw Error(ErrorCode::kUsage, option, text,
                        "some of " + joinWords(names, "and") + ", with commas between" +
                            afterStop(suggestion(part, names)));
        }
        if (part == kShadow) {
            channels.shadow = true;
        } else {
            channels.aovs.push_back(allAovs()[number]);
        }
    }
    return channels;
}

// Grids of layers that swallow light, but for the first, which is the volume.
std::vector<std::string> otherFogs(const MediumChoice& medium) {
    std::vector<std::string> grids;
    for (const LayerChoice& layer : medium.layers)
        if (layer.isFog()) grids.push_back(layer.grid);
    return grids;
}

}  // namespace

void addAovOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    group.addValue("--aov", "LIST", command.channels, Parser<ChannelChoice>(parseChannels),
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
                   "long as a picture or two, but for transmittance, which takes none;\n"
                   "front, back and samples, together, about half as long as\n"
                   "--deep-slices 1");
    group.addValue("--depth-opacity", "A", command.aovOptions.depthOpacity,
                   number(kLeastDepthOpacity, 1),
                   withDefault("--aov front: alpha that is passed there, 0.001 to 1",
                               numberText(command.aovOptions.depthOpacity)));
}

void checkAovs(const RenderCommand& command) {
    if (!command.channels.asked()) return;
    if (!isExr(command)) refuse(command.output.string(), "an .exr file");
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse("--mode " + modeName(mode), "--mode composite");
    if (command.deep) refuse("--deep besides", "a flat picture, or --deep alone");
    if (command.channels.has(Aov::kMattes) && otherFogs(command.picture.medium).empty())
        refuse("mattes of one volume", "several --layer that swallow light");
}

void warnOfUnusedAovOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display) {
    if (isGiven(app, "--depth-opacity") && !command.channels.has(Aov::kFront))
        display.warn("--depth-opacity: has no effect without --aov front");
}

std::vector<ImageChannel> withEmptyMattes(const MediumChoice& medium, const Optics& optics,
                                          std::vector<ImageChannel> channels) {
    std::vector<std::string> shown;
    for (const MediumPart& part : optics.parts) {
        if (part.kind == MediumPart::Kind::kAbsorption) shown.push_back(part.volume->name());
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

void warnOfDepths(const ChannelChoice& channels, const Optics& optics, const Listener& listener) {
    constexpr std::array kOfWhatHides{Aov::kDepth, Aov::kFront, Aov::kBack, Aov::kPosition,
                                      Aov::kSamples};
    if (optics.parts.empty()) return;
    const auto first = std::find_first_of(channels.aovs.begin(), channels.aovs.end(),
                                          kOfWhatHides.begin(), kOfWhatHides.end());
    if (first == channels.aovs.end()) return;
    listener.warn("--aov " + aovName(*first) +
                  ": is of what hides something; light of fire alone has none");
}

}  // namespace deltasplat
