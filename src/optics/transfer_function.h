// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace deltasplat {

/// How far x is on the way from a to b, 0..1; halves, so that no difference overflows.
inline double wayBetween(double a, double b, double x) {
    return (0.5 * x - 0.5 * a) / (0.5 * b - 0.5 * a);
}

/// Returns what defaultRange is of all volumes of a type; nothing if it is that of their values.
inline std::optional<glm::dvec2> rangeOfType(const std::string& type) {
    if (type == "uint8") return glm::dvec2(0, 255);
    return std::nullopt;
}

}  // namespace deltasplat
