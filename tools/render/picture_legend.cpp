// SPDX-License-Identifier: Apache-2.0
#include "render/picture_legend.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <memory>
#include <string>

#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "deltasplat/optics/default_ramp.h"
#include "drawing/shapes.h"
#include "optics/color_curve.h"
#include "options/transfer_function_option.h"
#include "render/list_presets.h"

namespace deltasplat {
namespace {

// Something to see even where all points lie at one value.
glm::dvec2 widened(glm::dvec2 range, const Volume& volume) {
    if (range.x < range.y) return range;
    range = {std::min(range.x, volume.valueMin()), std::max(range.y, volume.valueMax())};
    return range.x < range.y ? range : glm::dvec2(range.x - 0.5, range.x + 0.5);
}

ValueScale greys(const glm::dvec2& window) {
    ValueScale scale;
    scale.range = window;
    scale.colorOf = [window](double value) {
        const double share = std::clamp((value - window.x) / (window.y - window.x), 0.0, 1.0);
        const auto level = std::uint8_t(std::lround(255 * share));
        return Rgb{level, level, level};
    };
    return scale;
}

// The values of x = 0 and 1.
glm::dvec2 unitRange(const Volume& volume, const Optics& optics) {
    if (!optics.transferFunction.normalized) return {0, 1};
    return optics.range.value_or(defaultRange(volume));
}

ValueScale functionScale(const Volume& volume, const Optics& optics, bool withOpacity) {
    const TransferFunction& function = optics.transferFunction;
    const glm::dvec2 unit = unitRange(volume, optics);
    glm::dvec2 ends(function.colors.front().x, function.colors.back().x);
    // A single colour says nothing of where values begin and end.
    if (function.colors.size() == 1 || withOpacity) {
        const glm::dvec2 opacities(function.opacities.front().x, function.opacities.back().x);
        ends = function.colors.size() == 1
                   ? opacities
                   : glm::dvec2(std::min(ends.x, opacities.x), std::max(ends.y, opacities.y));
    }
    const Preset* const preset = findPreset(function.name);
    if (preset && preset->values == Preset::Values::kHounsfield)
        ends = shownPart(*preset, function);
    const auto valueAt = [unit](double x) { return unit.x + x * (unit.y - unit.x); };
    const auto placeOf = [unit](double value) { return (value - unit.x) / (unit.y - unit.x); };
    ValueScale scale;
    scale.range = widened({valueAt(ends.x), valueAt(ends.y)}, volume);
    const auto curve = std::make_shared<const ColorCurve>(function);
    scale.colorOf = [curve, placeOf](double value) {
        return shownColor(curve->at(placeOf(value)));
    };
    if (withOpacity)
        scale.opacityOf = [function, placeOf](double value) {
            return function.opacityAt(placeOf(value));
        };
    return scale;
}

// The names that a table gives labels, or without one the file.
std::map<int, std::string> namesOf(const std::filesystem::path& table, const Volume& volume) {
    std::map<int, std::string> names = labelNames(table);
    if (!names.empty() || !volume.labels()) return names;
    for (const LabelEntry& label : volume.labels()->entries) {
        if (!label.name.empty() && std::abs(label.value) < 1000000000)
            names[int(label.value)] = label.name;
    }
    return names;
}

// Those that are seen, by their numbers.
std::vector<LabelColor> labelsOf(const Volume& volume, const Optics& optics, bool withOpacity,
                                 const std::map<int, std::string>& names) {
    const TransferFunction& function = optics.transferFunction;
    const ColorCurve curve(function);
    const glm::dvec2 unit = unitRange(volume, optics);
    std::map<double, LabelColor> labels;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        const double value = volume.codeBook().valueOf(Code(code));
        const double x = (value - unit.x) / (unit.y - unit.x);
        if (withOpacity && !(function.opacityAt(x) > 0)) continue;
        const auto name = std::abs(value) < 1e9 ? names.find(int(value)) : names.end();
        labels[value] = {name == names.end() ? numberText(value) : name->second,
                         shownColor(curve.at(x))};
    }
    std::vector<LabelColor> rising;
    for (const auto& [value, label] : labels) rising.push_back(label);
    return rising;
}

}  // namespace

Legend pictureLegend(const RenderCommand& command, const Volume& volume, const Optics& optics,
                     const std::optional<glm::dvec2>& window) {
    Legend legend;
    legend.title = volume.name() + (isHounsfield(volume) ? " (HU)" : "");
    const bool withOpacity = command.picture.render.mode == Mode::kComposite;
    if (window) {
        legend.key = greys(*window);
    } else if (optics.transferFunction.categorical) {
        legend.key = labelsOf(volume, optics, withOpacity,
                              namesOf(command.picture.transferFunction, volume));
    } else {
        legend.key = functionScale(volume, optics, withOpacity);
    }
    return legend;
}

}  // namespace deltasplat
