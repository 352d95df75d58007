// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "drawing/drawing.h"
#include "image/srgb.h"

namespace deltasplat {

/// Returns the nearest colour that a screen shows of a scene-linear one.
inline Rgb shownColor(const glm::dvec3& linear) {
    const auto level = [](double v) {
        return std::uint8_t(std::lround(255 * std::clamp(srgbFromLinear(v), 0.0, 1.0)));
    };
    return {level(linear.r), level(linear.g), level(linear.b)};
}

inline Area rectangle(glm::dvec2 min, glm::dvec2 max, Rgb color) {
    return {{min, {max.x, min.y}, max, {min.x, max.y}}, color, 1};
}

/// How far a curve of opacities 0..1 goes at one of them: as its root, for what is thin to be seen
/// beside what is dense.
inline double opacityHeight(double opacity) {
    return std::sqrt(opacity);
}

}  // namespace deltasplat
