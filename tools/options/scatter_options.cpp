// SPDX-License-Identifier: Apache-2.0
#include "options/scatter_options.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/command_line.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

// With y up. White fog in the sun is then about as bright as white.
constexpr glm::dvec3 kDefaultSun(1, 2, 1);
constexpr double kDefaultSunStrength = 4;
constexpr std::int64_t kMostLights = 4096;

// One share for all colours, or three.
glm::dvec3 parseAlbedo(const std::string& option, const std::string& text) {
    const auto share = [&](const std::string& part) { return number(0, 1)(option, part); };
    const std::vector<std::string> parts = splitAt(text, ',');
    if (parts.size() == 1) return glm::dvec3(share(text));
    try {
        if (parts.size() == 3) return {share(parts[0]), share(parts[1]), share(parts[2])};
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text, "A or R,G,B, each within 0..1, as in 0.9");
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
    throw Error(ErrorCode::kUsage, option, text,
                "G within -0.99..0.99, or G,G2,SHARE of two lobes, SHARE of the second "
                "within 0..1, as in 0.8,-0.3,0.2");
}

ScatterChoice::SunPlace parseSky(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ':');
    ScatterChoice::SunPlace sun;
    try {
        sun.towards = vector3()(option, parts[0]);
        if (parts.size() == 2) sun.strength = number(0, kMostLight)(option, parts[1]);
        if (parts.size() <= 2 && sun.towards != glm::dvec3(0)) return sun;
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text,
                "X,Y,Z, the way towards the sun, not all 0, then, if wanted, :STRENGTH, "
                "as in 1,2,1:4");
}

// What turns y up into what is up, by the shortest way.
glm::dmat3 turnUp(const glm::dvec3& up) {
    const glm::dvec3 y(0, 1, 0);
    const glm::dvec3 to = glm::normalize(up);
    const glm::dvec3 axis = glm::cross(y, to);
    const double sine = glm::length(axis);
    const double cosine = glm::dot(y, to);
    if (sine == 0)
        return cosine > 0 ? glm::dmat3(1) : glm::dmat3({1, 0, 0}, {0, -1, 0}, {0, 0, -1});
    return glm::dmat3(glm::rotate(glm::dmat4(1), std::atan2(sine, cosine), axis));
}

void addTo(std::vector<Light>& lights, const std::vector<Light>& more, double strength) {
    for (Light light : more) {
        light.strength *= strength;
        lights.push_back(light);
    }
}

}  // namespace

// Where nothing is said, fog stands under a sky.
std::vector<Light> ScatterChoice::lights(const ShadingChoice& shading, bool isLitBesides,
                                         const glm::dvec3& up, const Listener& listener) const {
    std::vector<Light> all = shading.lights;
    std::optional<SunPlace> sun = sky;
    if (!sun && environment.empty() && all.empty() && !isLitBesides)
        sun = SunPlace{turnUp(up) * kDefaultSun, kDefaultSunStrength};
    if (sun) {
        const Sky day{sun->towards, up, turbidity, sun->strength, Sky{}.groundAlbedo};
        all.push_back(sunLight(day));
        addTo(all, cutIntoLights(skyEnvironment(day), environmentLights), 1);
    }
    if (!environment.empty()) {
        Environment light = readEnvironment(environment, listener);
        const glm::dmat3 turned(
            glm::rotate(glm::dmat4(1), glm::radians(environmentTurnDegrees), glm::normalize(up)));
        light.worldFromEnvironment = turned * turnUp(up);
        addTo(all, cutIntoLights(light, environmentLights), environmentStrength);
    }
    return all;
}

std::optional<Scattering> ScatterChoice::of(const ShadingChoice& shading, bool isLitBesides,
                                            const glm::dvec3& up, const Listener& listener) const {
    if (!asked()) return {};
    Scattering result = scattering;
    result.anisotropy = lobes.first;
    result.backAnisotropy = lobes.second;
    result.backShare = lobes.share;
    result.lights = lights(shading, isLitBesides, up, listener);
    if (shading.isAmbientGiven) result.ambient = glm::dvec3(shading.shading.ambient);
    return result;
}

std::vector<std::string> scatterOptions() {
    return {"--lighting",  "--albedo", "--anisotropy",   "--scatter-octaves", "--sky",
            "--turbidity", "--env",    "--env-strength", "--env-turn",        "--env-lights"};
}

void warnOfUnusedScatterOptions(const CLI::App& app, const ScatterChoice& choice,
                                const ShadingChoice& shading, bool isLitBesides,
                                ProgressDisplay& display) {
    const auto warnOf = [&](const std::vector<std::string>& options, const std::string& where) {
        const std::string remark = ": has no effect " + where;
        for (const std::string& option : options)
            if (isGiven(app, option)) display.warn(option + remark);
    };
    if (!choice.asked()) {
        std::vector<std::string> others = scatterOptions();
        others.erase(others.begin());
        return warnOf(others, "with --lighting emission");
    }
    warnOf({"--diffuse", "--specular", "--shininess"}, "on fog, which has no surfaces");
    const bool hasEnvironment = !choice.environment.empty();
    const bool isLit = hasEnvironment || !shading.lights.empty() || isLitBesides;
    const bool hasSky = choice.sky || !isLit;
    if (!hasSky) warnOf({"--turbidity"}, "without --sky");
    if (!hasEnvironment) warnOf({"--env-strength", "--env-turn"}, "without --env");
    if (!hasSky && !hasEnvironment) warnOf({"--env-lights"}, "without --sky or --env");
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
        "fog is lit by --light X,Y,Z and point:X,Y,Z, --sky and --env, and throws\n"
        "shadows into itself (default where anything below is given)");
    group.addValue("--sky", "X,Y,Z", choice.sky, Parser<ScatterChoice::SunPlace>(turnOn(parseSky)),
                   "Sun and clear sky: the way towards the sun in the world; :STRENGTH may\n"
                   "follow (default: 1,2,1:4 with y up, if there is no other light). Up is\n"
                   "that of --up, else y, or the head");
    group.addValue(
        "--turbidity", "T", choice.turbidity,
        Parser<double>(turnOn(number(kLeastTurbidity, kMostTurbidity))),
        withDefault("Haze of the sky, 2 (very clear) to 10", numberText(choice.turbidity)));
    group.addValue("--env", "FILE", choice.environment, Parser<std::string>(turnOn(anyText())),
                   "Light from everywhere: a lat-long picture (.exr, .hdr), y up, its\n"
                   "middle towards -z");
    group.addValue(
        "--env-strength", "S", choice.environmentStrength,
        Parser<double>(turnOn(number(0, kMostLight))),
        withDefault("What --env is multiplied by", numberText(choice.environmentStrength)));
    group.addValue("--env-turn", "DEG", choice.environmentTurnDegrees,
                   Parser<double>(turnOn(angle())), "Turns --env about what is up");
    group.addValue("--env-lights", "N", choice.environmentLights,
                   Parser<std::int64_t>(turnOn(wholeNumber(1, kMostLights))),
                   withDefault("Lights that a sky or --env is cut into",
                               std::to_string(choice.environmentLights)));
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
