// SPDX-License-Identifier: Apache-2.0
// Based on: VTK's documentation and behaviour of vtkColorTransferFunction, and Kenneth Moreland,
// "Diverging Color Maps for Scientific Visualization", 2009.
#include "optics/color_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/portable_math.h"
#include "image/srgb.h"
#include "optics/color_space.h"
#include "optics/transfer_function.h"

namespace deltasplat {
namespace {

using std::numbers::pi;

template <typename Function>
glm::dvec3 eachOf(const glm::dvec3& v, const Function& function) {
    return {function(v.x), function(v.y), function(v.z)};
}

// Saturations below are grey, which has no hue of its own.
constexpr double kGreySaturation = 0.05;

// The hue that grey of a magnitude takes on beside a colour: it spins on, for magnitudes to change
// evenly, and away from purple.
double hueOfGreyBeside(const glm::dvec3& color, double magnitude) {
    if (color.x >= magnitude - 0.1) return color.z;
    // Beside what is next to black it would spin many times around.
    constexpr double kBlackShare = 0.01;
    if (color.x < kBlackShare * magnitude) return color.z;
    const double spin = color.y * std::sqrt(magnitude * magnitude - color.x * color.x) /
                        (color.x * portable::sin(color.y));
    return color.z > -0.3 * pi ? color.z + spin : color.z - spin;
}

// Both are saturated, and their hues are more than a third of half a turn apart.
bool needWhiteBetween(const glm::dvec3& a, const glm::dvec3& b) {
    double apart = std::abs(a.z - b.z);
    apart = std::min(apart, 2 * pi - apart);
    return a.y > kGreySaturation && b.y > kGreySaturation && apart > 0.33 * pi;
}

// What no screen shows comes back to what one does, as VTK has it.
glm::dvec3 shown(glm::dvec3 linear) {
    linear = eachOf(linear, [](double v) { return std::max(v, 0.0); });
    const double most = std::max({linear.r, linear.g, linear.b});
    if (!(most > 1)) return linear;
    const double largest = srgbFromLinear(most);
    return eachOf(linear, [&](double v) { return linearFromSrgb(srgbFromLinear(v) / largest); });
}

}  // namespace

bool hasOneColor(const TransferFunction& function) {
    return std::all_of(function.colors.begin(), function.colors.end(),
                       [&](const TransferFunction::ColorPoint& point) {
                           return point.rgb == function.colors.front().rgb;
                       });
}

ColorCurve::ColorCurve(const TransferFunction& function)
    : space_(function.colorSpace),
      linearColors_(function.linearColors),
      first_(function.colors.front()),
      last_(function.colors.back()) {
    // What is turned into another space and back may not be quite what it was.
    if (!hasOneColor(function)) {
        for (std::size_t i = 1; i < function.colors.size(); ++i)
            addStretch(function.colors[i - 1], function.colors[i]);
    }
    for (TransferFunction::ColorPoint* end : {&first_, &last_})
        if (!linearColors_) end->rgb = eachOf(end->rgb, linearFromSrgb);
}

glm::dvec3 ColorCurve::at(double x) const {
    if (x < first_.x) return first_.rgb;
    const auto next = std::upper_bound(
        stretches_.begin(), stretches_.end(), x,
        [](double value, const Stretch& stretch) { return value < stretch.begin; });
    // Of several points at the same x the last one counts; the last of all ends the last stretch.
    if (next == stretches_.begin() || x >= last_.x) return last_.rgb;
    const Stretch& here = next[-1];
    const double s = wayBetween(here.begin, here.end, x);
    glm::dvec3 mixed;
    for (int i = 0; i < 3; ++i) mixed[i] = std::lerp(here.from[i], here.to[i], s);
    return linear(mixed);
}

void ColorCurve::addStretch(const TransferFunction::ColorPoint& left,
                            const TransferFunction::ColorPoint& right) {
    if (!(left.x < right.x)) return;
    glm::dvec3 from = mixable(left.rgb);
    glm::dvec3 to = mixable(right.rgb);
    if (space_ == ColorSpace::kDiverging) return addDiverging(left.x, right.x, from, to);
    if (space_ == ColorSpace::kHsvShortest && std::abs(from.x - to.x) > 0.5) {
        double& later = from.x > to.x ? from.x : to.x;
        later -= 1;
    }
    stretches_.push_back({left.x, right.x, from, to});
}

void ColorCurve::addDiverging(double begin, double end, glm::dvec3 from, glm::dvec3 to) {
    if (needWhiteBetween(from, to)) {
        constexpr double kLeastWhite = 88;
        const double white = std::max({from.x, to.x, kLeastWhite});
        const double middle = begin + 0.5 * (end - begin);
        if (begin < middle) addDiverging(begin, middle, from, {white, 0, 0});
        if (middle < end) addDiverging(middle, end, {white, 0, 0}, to);
        return;
    }
    if (from.y < kGreySaturation && to.y > kGreySaturation) {
        from.z = hueOfGreyBeside(to, from.x);
    } else if (to.y < kGreySaturation && from.y > kGreySaturation) {
        to.z = hueOfGreyBeside(from, to.x);
    }
    stretches_.push_back({begin, end, from, to});
}

glm::dvec3 ColorCurve::mixable(const glm::dvec3& rgb) const {
    const auto linear = [&] { return linearColors_ ? rgb : eachOf(rgb, linearFromSrgb); };
    switch (space_) {
        case ColorSpace::kHsv:
        case ColorSpace::kHsvShortest:
            return hsvFromRgb(rgb);
        case ColorSpace::kLab:
            return labFromLinear(linear());
        case ColorSpace::kDiverging:
            return mshFromLab(labFromLinear(linear()));
        case ColorSpace::kRgb:
            break;
    }
    return rgb;
}

glm::dvec3 ColorCurve::linear(const glm::dvec3& mixed) const {
    glm::dvec3 rgb = mixed;
    switch (space_) {
        case ColorSpace::kLab:
        case ColorSpace::kDiverging:
            rgb = linearFromLab(space_ == ColorSpace::kLab ? mixed : labFromMsh(mixed));
            if (!linearColors_) return shown(rgb);
            return eachOf(rgb, [](double v) { return std::max(v, 0.0); });
        case ColorSpace::kHsv:
        case ColorSpace::kHsvShortest:
            rgb = rgbFromHsv({mixed.x < 0 ? mixed.x + 1 : mixed.x, mixed.y, mixed.z});
            break;
        case ColorSpace::kRgb:
            break;
    }
    return linearColors_ ? rgb : eachOf(rgb, linearFromSrgb);
}

}  // namespace deltasplat
