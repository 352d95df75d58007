// SPDX-License-Identifier: Apache-2.0
#include "annotate/scale_bar.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "drawing/nice_step.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

struct Length {
    double world;
    std::string text;
};

// A round length: of the world's unit, or of the next smaller one of which it is one or more.
Length roundLength(double most, const std::string& unit) {
    const double own = niceStep(most, 1);
    if (unit.empty()) return {own, numberText(own) + " units"};
    if (own >= 1) return {own, numberText(own) + " " + unit};
    for (const char* const smaller : {"m", "mm", "um", "nm", "pm"}) {
        const double scale = millimetresIn(unit) / millimetresIn(smaller);
        // A length that is round in both is not lost to a rounding.
        constexpr double kRounding = 1e-9;
        const double count = niceStep(most * scale * (1 + kRounding), 1);
        if (count >= 1) return {count / scale, numberText(count) + " " + smaller};
    }
    return {own, numberText(own) + " " + unit};
}

}  // namespace

ScaleBar scaleBarOf(const Camera& camera, const std::string& lengthUnit) {
    constexpr double kMostShare = 0.3;
    ScaleBar bar;
    const Length length = roundLength(kMostShare * camera.frameWidthWorld, lengthUnit);
    bar.lengthWorld = length.world;
    bar.lengthPixels = bar.lengthWorld / camera.pixelWorld();
    bar.label = length.text;
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
