// SPDX-License-Identifier: Apache-2.0
#include "options/surface_options.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/command_line.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

// Pairs in increasing order: a change of values, and a factor.
Parser<std::vector<glm::dvec2>> steps() {
    return [](const std::string& option, const std::string& text) {
        std::vector<glm::dvec2> points;
        try {
            for (const std::string& part : splitAt(text, ',')) {
                const std::vector<std::string> pair = splitAt(part, ':');
                if (pair.size() != 2) throw Error(ErrorCode::kUsage, "");
                points.emplace_back(number(0)(option, pair[0]), number(0, 1)(option, pair[1]));
            }
        } catch (const Error&) {
            points.clear();
        }
        const auto isBefore = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; };
        if (!points.empty() && std::is_sorted(points.begin(), points.end(), isBefore))
            return points;
        throw Error(ErrorCode::kUsage, option, text,
                    "GRADIENT:FACTOR,..., gradients of at least 0 in increasing order, "
                    "factors within 0..1, as in 0:0,200:1");
    };
}

Parser<glm::dvec3> opaqueColor() {
    return [](const std::string& option, const std::string& text) {
        try {
            if (splitAt(text, ',').size() == 3) return glm::dvec3(glm::vec3(color()(option, text)));
        } catch (const Error&) {
            // What is said of it must not offer a fourth number.
        }
        throw Error(ErrorCode::kUsage, option, text.empty() ? "nothing" : text,
                    "R,G,B, three numbers of at least 0");
    };
}

}  // namespace

std::optional<Surface> SurfaceChoice::of(const Volume& volume) const {
    Surface surface;
    if (color) surface.color = *color;
    if (isovalue) {
        surface.isovalue = *isovalue;
        return surface;
    }
    if (isLevelSet(volume) && (asked || ofLevelSets)) return surface;
    if (!asked) return {};
    throw Error(ErrorCode::kUsage, "--surface",
                volume.gridClass() == "unknown" ? "values that are no distances"
                                                : "a " + volume.gridClass(),
                "a level set, or --isovalue V");
}

void addSurfaceOptions(CLI::App& app, SurfaceChoice& choice,
                       std::vector<glm::dvec2>& gradientOpacity) {
    OptionGroup group(app, "Surfaces");
    group.addFlag("--surface", choice.asked,
                  "Show where a level set is 0 as an opaque surface (default for\n"
                  "level sets, unless --level-set, --tf, --range, --extinction,\n"
                  "--unit-distance, --color-by, --gradient-opacity or light in fog is\n"
                  "given)");
    group.addValue("--isovalue", "V", choice.isovalue, number(),
                   "Show where values pass V, in data units, as an opaque surface");
    group.addValue("--surface-color", "R,G,B", choice.color, opaqueColor(),
                   "Its scene-linear colour (default: that of --tf at V, else grey)");
    group.addValue("--gradient-opacity", "G:F,...", gradientOpacity, steps(),
                   "Multiplies opacity by F where values change by G data units a\n"
                   "world unit, straight between such points: 0:0,200:1 clears what is\n"
                   "homogeneous");
}

void applySurface(const CLI::App& app, Mode mode, bool isFog, SurfaceChoice& choice,
                  ReadOptions& read) {
    if (choice.isovalue) choice.asked = true;
    const auto isAnyGiven = [&](std::initializer_list<const char*> options) {
        return std::any_of(options.begin(), options.end(),
                           [&](const char* option) { return isGiven(app, option); });
    };
    choice.ofLevelSets = mode == Mode::kComposite && !isFog &&
                         !isAnyGiven({"--level-set", "--tf", "--range", "--extinction",
                                      "--unit-distance", "--color-by", "--gradient-opacity"});
    choice.isFogGiven = isGiven(app, "--level-set") && read.levelSetToFog;
    if (mode != Mode::kComposite) choice = SurfaceChoice{false, false, false, {}, {}};
    if (choice.isFogGiven) return;
    if (choice.asked || choice.ofLevelSets) read.levelSetToFog = false;
}

}  // namespace deltasplat
