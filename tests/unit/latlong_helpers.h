// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "deltasplat/optics/environment.h"

namespace deltasplat::test {

/// The way to a pixel's middle, in the environment's own space.
inline glm::dvec3 pixelWay(glm::ivec2 size, int x, int y) {
    const double longitude = 2 * std::numbers::pi * ((x + 0.5) / size.x - 0.5);
    const double latitude = std::numbers::pi * (0.5 - (y + 0.5) / size.y);
    return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
            -std::cos(latitude) * std::cos(longitude)};
}

inline double solidAngle(glm::ivec2 size, int y) {
    const double pi = std::numbers::pi;
    return 2 * pi / size.x *
           (std::sin(pi * (0.5 - double(y) / size.y)) - std::sin(pi * (0.5 - (y + 1.0) / size.y)));
}

inline glm::dvec3 radiance(const Environment& environment, int x, int y) {
    const float* rgb =
        &environment
             .rgb[3 * (std::size_t(y) * std::size_t(environment.sizePixels.x) + std::size_t(x))];
    return {rgb[0], rgb[1], rgb[2]};
}

/// Adds up radiance times solid angle times what `weigh` says of the way to a pixel.
template <typename Weigh>
glm::dvec3 integrate(const Environment& environment, Weigh weigh) {
    const glm::ivec2 size = environment.sizePixels;
    glm::dvec3 sum(0);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            sum += solidAngle(size, y) * weigh(pixelWay(size, x, y)) * radiance(environment, x, y);
        }
    }
    return sum;
}

/// The irradiance on a plane.
inline glm::dvec3 irradiance(const Environment& environment, const glm::dvec3& normal) {
    return integrate(environment,
                     [&](const glm::dvec3& way) { return std::max(0.0, glm::dot(normal, way)); });
}

inline double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace deltasplat::test
