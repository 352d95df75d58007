// SPDX-License-Identifier: Apache-2.0
#include "options/medium_options.h"

#include <algorithm>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/shading.h"
#include "options/command_line.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

constexpr const char* kFire = "fire";
constexpr std::int64_t kMostLights = 4096;

LayerChoice parseLayer(const std::string& option, const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string shown = colon == std::string::npos ? "" : text.substr(colon + 1);
    if (colon == 0 || shown.empty()) {
        throw Error(ErrorCode::kUsage, option, text,
                    "GRID:TF, TF being a file, a preset or fire, as in heat:fire");
    }
    return {text.substr(0, colon), shown == kFire ? "" : shown};
}

// A scale, or a scale and an offset.
glm::dvec2 parseKelvin(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ',');
    try {
        if (parts.size() == 1) return {number()(option, parts[0]), 0};
        if (parts.size() == 2) return {number()(option, parts[0]), number()(option, parts[1])};
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text, "SCALE or SCALE,OFFSET, as in 1,273.15");
}

}  // namespace

bool MediumChoice::burns() const {
    return emissionGrid || std::ranges::any_of(layers, &LayerChoice::isFire);
}

std::vector<std::string> mediumOptions() {
    return {"--emission-grid",   "--emission-tf",       "--emission-range", "--emission-strength",
            "--emission-lights", "--temperature-scale", "--color-grid",     "--layer"};
}

void warnOfUnusedMediumOptions(const CLI::App& app, const MediumChoice& choice,
                               ProgressDisplay& display) {
    const auto warnOf = [&](const std::vector<std::string>& options, const std::string& remark) {
        const std::string effect = ": has no effect " + remark;
        for (const std::string& option : options)
            if (isGiven(app, option)) display.warn(option + effect);
    };
    if (!choice.burns()) {
        warnOf({"--emission-tf", "--emission-range", "--emission-strength", "--temperature-scale"},
               "without --emission-grid, or a --layer shown as fire");
        return;
    }
    if (choice.emissionFunction.empty()) {
        warnOf({"--emission-range"}, "without --emission-tf");
    } else {
        warnOf({"--temperature-scale"}, "with --emission-tf, which is of values");
    }
}

void addMediumOptions(CLI::App& app, MediumChoice& choice) {
    OptionGroup group(app, "Fire and colour, .vdb");
    group.addValue("--emission-grid", "NAME", choice.emissionGrid, anyText(),
                   "Grid that shines beside the volume, such as flame or temperature, or\n"
                   "auto: the first of flame, flames, fire, burn, heat, temperature");
    group.addValue("--temperature-scale", "S[,K]", choice.kelvin, Parser<glm::dvec2>(parseKelvin),
                   "Kelvin of values: S times the value, plus K (default: 1, or 2000 where\n"
                   "values reach no more than 20)");
    group.addValue("--emission-tf", "FILE|PRESET", choice.emissionFunction, anyText(),
                   "Colours that values shine in, and as opacities their strength, in\n"
                   "place of those of black bodies");
    group.addValue("--emission-range", "LO,HI", choice.emissionRange, interval(),
                   "Values that 0 and 1 of a normalized --emission-tf stand for (default:\n"
                   "all values)");
    group.addValue(
        "--emission-strength", "S", choice.emissionStrength, number(0, kMostLight),
        withDefault("What all that shines is multiplied by", numberText(choice.emissionStrength)));
    group.addValue("--emission-lights", "N", choice.emissionLights, wholeNumber(1, kMostLights),
                   "Point lights that what shines is cut into, at most, to light the fog of\n"
                   "--lighting scatter (default: fire is seen, and lights nothing)");
    group.addValue("--color-grid", "NAME", choice.colorGrid, anyText(),
                   "Vector grid that the volume's colours are multiplied by, such as Cd,\n"
                   "or three float grids R,G,B, or auto: the first of Cd, color, albedo");
    group.addEach("--layer", "GRID:TF", choice.layers, Parser<LayerChoice>(parseLayer),
                  "Grid and how it is shown: a file or preset as --tf takes them, or\n"
                  "fire. Given several times, all are one medium (in place of --grid,\n"
                  "--tf and --emission-grid)");
}

}  // namespace deltasplat
