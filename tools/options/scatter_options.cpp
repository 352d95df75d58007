// SPDX-License-Identifier: Apache-2.0
#include "options/scatter_options.h"

#include <string>

#include "deltasplat/error.h"
#include "number_text.h"
#include "options/command_line.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

// One share for all colours, or three.
glm::dvec3 parseAlbedo(const std::string& option, const std::string& text) {
    const auto share = [&](const std::string& part) { return number(0, 1)(option, part); };
    const std::vector<std::string> parts = splitAt(text, ',');
    if (parts.size() == 1) return glm::dvec3(share(text));
    try {
        if (parts.size() == 3) return {share(parts[0]), share(parts[1]), share(parts[2])};
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage,
                gotExpected(option, text, "A or R,G,B, each within 0..1, as in 0.9"));
}

ScatterChoice::Lobes parseLobes(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ',');
    const auto lobe = number(-kMostAnisotropy, kMostAnisotropy);
    try {
        if (parts.size() == 1) return {lobe(option, text), 0, 0};
        if (parts.size() == 3)
            return {lobe(option, parts[0]), lobe(option, parts[1]), number(0, 1)(option, parts[2])};
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage,
                gotExpected(option, text,
                            "G within -0.99..0.99, or G,G2,SHARE of two lobes, SHARE of the second "
                            "within 0..1, as in 0.8,-0.3,0.2"));
}

}  // namespace

std::optional<Scattering> ScatterChoice::of(const ShadingChoice& shading) const {
    if (!asked()) return {};
    Scattering result = scattering;
    result.anisotropy = lobes.first;
    result.backAnisotropy = lobes.second;
    result.backShare = lobes.share;
    result.lights = shading.lights;
    if (shading.isAmbientGiven) result.ambient = glm::dvec3(shading.shading.ambient);
    return result;
}

void addScatterOptions(CLI::App& app, ScatterChoice& choice) {
    OptionGroup group(app, "Light in fog");
    Scattering& scattering = choice.scattering;
    const auto turnOn = [&](const auto& parse) {
        return [&choice, parse](const std::string& option, const std::string& text) {
            choice.isAnyGiven = true;
            return parse(option, text);
        };
    };
    group.addValue(
        "--lighting", "HOW", choice.scatters,
        Parser<bool>([](const std::string& option, const std::string& text) {
            return deltasplat::choice({"emission", "scatter"})(option, text) == "scatter";
        }),
        "emission (what is shown shines by itself, the default) or scatter:\n"
        "fog is lit by --light, and throws shadows into itself (default where\n"
        "anything below is given)");
    group.addValue(
        "--albedo", "A", scattering.albedo, Parser<glm::dvec3>(turnOn(parseAlbedo)),
        withDefault("Share of light that fog scatters, not swallows: A or R,G,B, 0..1", "1"));
    group.addValue("--anisotropy", "G", choice.lobes,
                   Parser<ScatterChoice::Lobes>(turnOn(parseLobes)),
                   "How far fog scatters light forwards (Henyey-Greenstein): -0.99..0.99,\n"
                   "0 evenly; or G,G2,SHARE of two lobes (default 0)");
    group.addValue("--scatter-octaves", "N", scattering.octaves,
                   Parser<std::int64_t>(turnOn(wholeNumber(0, kMostOctaves))),
                   withDefault("How often light is scattered again, each time less, from farther\n"
                               "and more evenly: 0..8; an approximation for clouds",
                               std::to_string(scattering.octaves)));
}

}  // namespace deltasplat
