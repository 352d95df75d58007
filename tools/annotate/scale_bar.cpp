// SPDX-License-Identifier: Apache-2.0
#include "annotate/scale_bar.h"

#include <algorithm>
#include <cmath>

#include "drawing/nice_step.h"
#include "length_unit.h"
#include "number_text.h"

namespace deltasplat {

namespace {

// Of a unit that is known, or of the next smaller ones of which it is one or more.
std::string lengthText(double length, const std::string& unit) {
    if (unit.empty()) return numberText(length) + " units";
    const double millimetres = length * millimetresIn(unit);
    if (length >= 1) return numberText(length) + " " + unit;
    for (const char* const smaller : {"m", "mm", "um", "nm", "pm"}) {
        const double count = millimetres / millimetresIn(smaller);
        // A round number that the way by millimetres has moved off by a rounding.
        constexpr double kRounding = 1e-9;
        if (count < 1 - kRounding) continue;
        const double digits = std::pow(10, std::floor(std::log10(count) + kRounding));
        return numberText(std::round(count / digits) * digits) + " " + smaller;
    }
    return numberText(length) + " " + unit;
}

}  // namespace

ScaleBar scaleBarOf(const Camera& camera, const std::string& lengthUnit) {
    constexpr double kMostShare = 0.3;
    ScaleBar bar;
    bar.lengthWorld = niceStep(kMostShare * camera.frameWidthWorld, 1);
    bar.lengthPixels = bar.lengthWorld / camera.pixelWorld();
    bar.label = lengthText(bar.lengthWorld, lengthUnit);
    if (camera.projection == Projection::kPerspective) bar.label += " at target";
    return bar;
}

Annotation drawScaleBar(const ScaleBar& bar, const AnnotationStyle& style) {
    const double right = style.picture.x - style.margin;
    const double bottom = style.picture.y - style.margin;
    const double left = right - bar.lengthPixels;
    const double end = std::max(1.0, std::round(0.12 * style.font));
    const double top = bottom - std::round(0.6 * style.font);
    const double middle = 0.5 * (top + bottom);
    const double low = middle + end;
    const double high = middle - end;
    Ink ink(style.font, style.colors);
    // One shape: between its ends, which stand upright, it lies.
    ink.area({{{left, top},
               {left + end, top},
               {left + end, high},
               {right - end, high},
               {right - end, top},
               {right, top},
               {right, bottom},
               {right - end, bottom},
               {right - end, low},
               {left + end, low},
               {left + end, bottom},
               {left, bottom}},
              style.colors.ink,
              1});
    ink.text({right, top - 0.5 * style.font}, bar.label, Label::Anchor::kEnd);
    return makeAnnotation("--scale-bar", ink);
}

}  // namespace deltasplat
