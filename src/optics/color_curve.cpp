// SPDX-License-Identifier: Apache-2.0
// Based on: VTK's documentation and behaviour of vtkColorTransferFunction, and Kenneth Moreland,
// "Diverging Color Maps for Scientific Visualization", 2009.
#include "optics/color_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
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

// Colours of lower saturation count as grey, which has no hue of its own.
constexpr double kGreySaturation = 0.05;

// Hue of a grey beside a colour. Spins on, away from purple, so that magnitudes change evenly.
double hueOfGreyBeside(const glm::dvec3& color, double magnitude) {
    if (color.x >= magnitude - 0.1) return color.z;
    // Beside near-black colours the hue would spin many times around.
    constexpr double kBlackShare = 0.01;
    if (color.x < kBlackShare * magnitude) return color.z;
    const double spin = color.y * std::sqrt(magnitude * magnitude - color.x * color.x) /
                        (color.x * portable::sin(color.y));
    return color.z > -0.3 * pi ? color.z + spin : color.z - spin;
}

// Whether both colours are saturated, with hues more than 0.33 pi apart.
bool needWhiteBetween(const glm::dvec3& a, const glm::dvec3& b) {
    double apart = std::abs(a.z - b.z);
    apart = std::min(apart, 2 * pi - apart);
    return a.y > kGreySaturation && b.y > kGreySaturation && apart > 0.33 * pi;
}

// Fits colours outside the screen's gamut into the gamut, as VTK does.
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
    // Converting one colour to another space and back would change its last bits.
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
    // Of several points at the same x the last one counts; the last point ends the last stretch.
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

namespace {

using std::numbers::pi;

double radians(double degrees) {
    return degrees * pi / 180;
}

double square(double v) {
    return v * v;
}

// The saturation of a chroma in the formula's corrections for blue and grey.
double saturation(double chroma) {
    const double power = chroma * square(chroma * chroma * chroma);
    constexpr double k25 = 6103515625;  // 25^7
    return std::sqrt(power / (power + k25));
}

double hueOf(double a, double b) {
    if (a == 0 && b == 0) return 0;
    const double hue = portable::atan2(b, a);
    return hue < 0 ? hue + 2 * pi : hue;
}

// Middle of the shorter way around; grey has no hue.
double meanHue(double hue1, double hue2, bool grey) {
    if (grey) return hue1 + hue2;
    if (std::abs(hue1 - hue2) <= pi) return 0.5 * (hue1 + hue2);
    return 0.5 * (hue1 + hue2) + (hue1 + hue2 < 2 * pi ? pi : -pi);
}

double hueWeight(double hue) {
    return 1 - 0.17 * portable::cos(hue - radians(30)) + 0.24 * portable::cos(2 * hue) +
           0.32 * portable::cos(3 * hue + radians(6)) - 0.2 * portable::cos(4 * hue - radians(63));
}

glm::dvec3 linearOf(const glm::dvec3& rgb) {
    return {linearFromSrgb(rgb.r), linearFromSrgb(rgb.g), linearFromSrgb(rgb.b)};
}

glm::dvec3 labOf(const glm::dvec3& rgb) {
    return labFromLinear(linearOf(rgb));
}

}  // namespace

double colorDifference(const glm::dvec3& lab1, const glm::dvec3& lab2) {
    const double plainChroma =
        0.5 * (portable::hypot(lab1.y, lab1.z) + portable::hypot(lab2.y, lab2.z));
    const double stretch = 1 + 0.5 * (1 - saturation(plainChroma));
    const double a1 = stretch * lab1.y;
    const double a2 = stretch * lab2.y;
    const double chroma1 = portable::hypot(a1, lab1.z);
    const double chroma2 = portable::hypot(a2, lab2.z);
    const bool grey = chroma1 * chroma2 == 0;
    const double hue1 = hueOf(a1, lab1.z);
    const double hue2 = hueOf(a2, lab2.z);

    double turn = grey ? 0 : hue2 - hue1;
    if (turn > pi) turn -= 2 * pi;
    if (turn < -pi) turn += 2 * pi;
    const double lightness = 0.5 * (lab1.x + lab2.x) - 50;
    const double chroma = 0.5 * (chroma1 + chroma2);
    const double hue = meanHue(hue1, hue2, grey);
    const double byLightness =
        (lab2.x - lab1.x) / (1 + 0.015 * square(lightness) / std::sqrt(20 + square(lightness)));
    const double byChroma = (chroma2 - chroma1) / (1 + 0.045 * chroma);
    const double byHue = 2 * std::sqrt(chroma1 * chroma2) * portable::sin(0.5 * turn) /
                         (1 + 0.015 * chroma * hueWeight(hue));
    const double blue = radians(30) * portable::exp(-square((hue - radians(275)) / radians(25)));
    const double rotation = -portable::sin(2 * blue) * 2 * saturation(chroma);
    return std::sqrt(std::max(
        0.0, square(byLightness) + square(byChroma) + square(byHue) + rotation * byChroma * byHue));
}

ColorPaths::ColorPaths() : steps_(std::size_t{kPoints} * kNeighbours, -1) {
    for (int r = 0; r < kLevels; ++r)
        for (int g = 0; g < kLevels; ++g)
            for (int b = 0; b < kLevels; ++b)
                lab_.push_back(labOf(glm::dvec3(r, g, b) / (kLevels - 1.0)));
}

double ColorPaths::stepLength(int point, int neighbour, int other) {
    double& length = steps_[std::size_t(point) * kNeighbours + neighbour];
    if (length < 0) {
        length = colorDifference(lab_[point], lab_[other]);
        steps_[std::size_t(other) * kNeighbours + (kNeighbours - 1 - neighbour)] = length;
    }
    return length;
}

// E. W. Dijkstra's algorithm, from the last point to the first.
std::vector<int> ColorPaths::pointsBetween(int from, int to) {
    std::vector<double> lengths(kPoints, std::numeric_limits<double>::infinity());
    std::vector<int> next(kPoints, to);
    std::set<std::pair<double, int>> front{{0, to}};
    lengths[to] = 0;
    while (front.begin()->second != from) {
        const auto [length, point] = *front.begin();
        front.erase(front.begin());
        const glm::ivec3 at(point / (kLevels * kLevels), point / kLevels % kLevels,
                            point % kLevels);
        for (int neighbour = 0; neighbour < kNeighbours; ++neighbour) {
            const glm::ivec3 p =
                at + glm::ivec3(neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1);
            if (std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) >= kLevels) continue;
            const int other = (p.x * kLevels + p.y) * kLevels + p.z;
            if (lengths[other] <= length) continue;
            const double there = length + stepLength(point, neighbour, other);
            if (!(there < lengths[other])) continue;
            front.erase({lengths[other], other});
            front.insert({there, other});
            lengths[other] = there;
            next[other] = point;
        }
    }
    std::vector<int> points{from};
    while (points.back() != to) points.push_back(next[points.back()]);
    return points;
}

std::vector<ColorPaths::Stop> ColorPaths::between(const glm::dvec3& from, const glm::dvec3& to) {
    const auto nearest = [](const glm::dvec3& rgb) {
        const auto level = [](double v) { return int(v * (kLevels - 1) + 0.5); };
        return (level(rgb.r) * kLevels + level(rgb.g)) * kLevels + level(rgb.b);
    };
    std::vector<Stop> stops{{from, 0}};
    const std::vector<int> points = pointsBetween(nearest(from), nearest(to));
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const int point = points[i];
        const glm::dvec3 levels(point / (kLevels * kLevels), point / kLevels % kLevels,
                                point % kLevels);
        stops.push_back({levels / (kLevels - 1.0), 0});
    }
    stops.push_back({to, 0});

    // The ends are now the colours themselves, so measure again.
    for (std::size_t i = 1; i < stops.size(); ++i) {
        stops[i].share =
            stops[i - 1].share + colorDifference(labOf(stops[i - 1].rgb), labOf(stops[i].rgb));
    }
    const double length = stops.back().share;
    for (Stop& stop : stops)
        if (length > 0) stop.share /= length;
    stops.back().share = 1;
    return stops;
}

}  // namespace deltasplat
