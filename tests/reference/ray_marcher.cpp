// SPDX-License-Identifier: Apache-2.0
#include "reference/ray_marcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/formulas.h"

namespace reference {
namespace {

double trilinear(const Medium& medium, const Vector& at) {
    const int x = int(std::floor(at[0]));
    const int y = int(std::floor(at[1]));
    const int z = int(std::floor(at[2]));
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = x + (corner & 1);
        const int j = y + (corner >> 1 & 1);
        const int k = z + (corner >> 2 & 1);
        const double weight = linear(at[0] - i) * linear(at[1] - j) * linear(at[2] - k);
        if (weight > 0) sum += weight * medium.valueAt(i, j, k);
    }
    return sum;
}

// The stretch of a line of sight, in its own units, along which anything can be met.
std::array<double, 2> stretchOf(const Medium& medium, const Vector& from, const Vector& along) {
    std::array<double, 2> stretch{0, std::numeric_limits<double>::infinity()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = medium.first[axis] - 1.0;
        const double high = medium.last[axis] + 1.0;
        if (along[axis] == 0) {
            if (from[axis] < low || from[axis] > high) return {0, 0};
            continue;
        }
        const double a = (low - from[axis]) / along[axis];
        const double b = (high - from[axis]) / along[axis];
        stretch[0] = std::max(stretch[0], std::min(a, b));
        stretch[1] = std::min(stretch[1], std::max(a, b));
    }
    return stretch;
}

Rgba follow(const Medium& medium, const Vector& eye, const Vector& towards, double step) {
    Vector world{};
    for (std::size_t i = 0; i < 3; ++i) world[i] = eye[i] - medium.origin[i];
    const double length = std::sqrt(dot(towards, towards));
    Vector unit{};
    for (std::size_t i = 0; i < 3; ++i) unit[i] = towards[i] / length;
    const Vector from = indexComponents(medium.axes, world);
    const Vector along = indexComponents(medium.axes, unit);
    const auto [begin, end] = stretchOf(medium, from, along);
    Rgba light{};
    for (double t = begin + 0.5 * step; t < end; t += step) {
        const Vector at{from[0] + t * along[0], from[1] + t * along[1], from[2] + t * along[2]};
        const auto look = medium.look(trilinear(medium, at));
        const double opacity = 1 - std::pow(1 - look[3], step);
        const double clear = 1 - light[3];
        for (std::size_t c = 0; c < 3; ++c) light[c] += clear * opacity * look[c];
        light[3] += clear * opacity;
    }
    return light;
}

}  // namespace

Picture march(const Medium& medium, const Eye& eye, double step) {
    Picture picture;
    const int n = eye.samples;
    for (int y = 0; y < eye.height; ++y) {
        for (int x = 0; x < eye.width; ++x) {
            Rgba sum{};
            for (int i = 0; i < n * n; ++i) {
                const double px = x + (i % n + 0.5) / n;
                const double py = y + (i / n + 0.5) / n;
                const auto light = follow(medium, eye.from(px, py), eye.towards(px, py), step);
                for (std::size_t c = 0; c < 4; ++c) sum[c] += light[c] / (n * n);
            }
            picture.push_back(sum);
        }
    }
    return picture;
}

}  // namespace reference
