// SPDX-License-Identifier: Apache-2.0
#include "optics/color_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "base/portable_math.h"
#include "image/srgb.h"
#include "optics/color_space.h"

namespace deltasplat {
namespace {

using std::numbers::pi;

double radians(double degrees) {
    return degrees * pi / 180;
}

double square(double v) {
    return v * v;
}

// How much of full saturation a chroma has, as the formula's corrections for blue and grey have it.
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

// In the middle of the shorter way around; grey has no hue.
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

    // Its ends have moved to the colours themselves.
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
