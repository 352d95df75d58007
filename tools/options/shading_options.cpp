// SPDX-License-Identifier: Apache-2.0
#include "options/shading_options.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/command_line.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

// X,Y,Z and, if wanted, a radius.
void parsePlace(const std::string& option, const std::string& text, Light& light) {
    const std::size_t comma = text.find(',', text.find(',', text.find(',') + 1) + 1);
    const bool hasRadius = std::count(text.begin(), text.end(), ',') == 3;
    light.positionWorld = vector3()(option, hasRadius ? text.substr(0, comma) : text);
    if (hasRadius) light.radiusWorld = number(0, kFarthestLight)(option, text.substr(comma + 1));
}

// Where it comes from, then its colour, if any, then its strength, if any.
Light parseLight(const std::string& option, const std::string& text) {
    const auto refuse = [&] {
        return Error(ErrorCode::kUsage, option, text,
                     "head, X,Y,Z or view:X,Y,Z, numbers from -1e+30 to 1e+30 and not "
                     "all 0, or point:X,Y,Z or point:X,Y,Z,RADIUS, then, if wanted, "
                     ":R,G,B, each at least 0, and :STRENGTH, 0 to 1e+06, as in "
                     "view:1,-1,-1:1,0.9,0.8:1.5");
    };
    const std::vector<std::string> parts = splitAt(text, ':');
    std::size_t next = 0;
    Light light;
    try {
        if (parts[0] == "head") {
            next = 1;
        } else {
            const bool isPoint = parts[0] == "point";
            light.frame = parts[0] == "view" ? LightFrame::kView : LightFrame::kWorld;
            if (isPoint || light.frame == LightFrame::kView) next = 1;
            const std::string place = next < parts.size() ? parts[next] : "";
            if (isPoint) {
                parsePlace(option, place, light);
            } else {
                light.direction = vector3()(option, place);
            }
            ++next;
        }
        if (next < parts.size() && parts[next].find(',') != std::string::npos)
            light.color = glm::dvec3(color()(option, parts[next++]));
        if (next < parts.size()) light.strength = number(0, kMostLight)(option, parts[next++]);
    } catch (const Error&) {
        throw refuse();
    }
    if (next != parts.size() || light.direction == glm::dvec3(0)) throw refuse();
    return light;
}

}  // namespace

std::optional<Shading> ShadingChoice::of(bool suits) const {
    if (!shades.value_or(isAnyGiven || suits)) return {};
    Shading result = shading;
    if (!lights.empty()) result.lights = lights;
    return result;
}

void addShadingOptions(CLI::App& app, ShadingChoice& choice) {
    OptionGroup group(app, "Shading");
    Shading& shading = choice.shading;
    const auto turnOn = [&](const auto& parse) {
        return [&choice, parse](const std::string& option, const std::string& text) {
            choice.isAnyGiven = true;
            if (option == "--ambient") choice.isAmbientGiven = true;
            return parse(option, text);
        };
    };
    group.addSwitch("--shade", "--no-shade", choice.shades,
                    "Light what is shown as surfaces, by the gradient of the values:\n"
                    "in relief (default: for level sets and presets of CT, and where\n"
                    "anything below is given)");
    group.addEach("--light", "LIGHT", choice.lights, Parser<Light>(turnOn(parseLight)),
                  "head (from the camera, the default) or X,Y,Z, the way that light\n"
                  "travels in the world, or view:X,Y,Z in the picture (right, up,\n"
                  "towards the camera); then :R,G,B and :STRENGTH, if wanted. In fog\n"
                  "also point:X,Y,Z, a place in the world: STRENGTH is that 1 world unit\n"
                  "away, and falls with the square of the distance; of\n"
                  "point:X,Y,Z,RADIUS it is the same within RADIUS. Can be given several\n"
                  "times");
    const auto addShare = [&](const std::string& name, double& target, const std::string& help) {
        group.addValue(name, "K", target, Parser<double>(turnOn(number(0, kMostLight))),
                       withDefault(help, numberText(target)));
    };
    addShare("--ambient", shading.ambient, "Share of its colour that is seen without any light");
    addShare("--diffuse", shading.diffuse, "Share that light reflects evenly to all sides");
    addShare("--specular", shading.specular, "Share of light that surfaces mirror, in its colour");
    addShare("--shininess", shading.shininess, "How small highlights are: exponent of the cosine");
}

}  // namespace deltasplat
