// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns a vector's direction, of length 1. Its square may be too large or too small for a
/// number.
/// @param v  finite, not 0
inline glm::dvec3 unitVectorOf(const glm::dvec3& v) {
    const glm::dvec3 size = glm::abs(v);
    return glm::normalize(v / std::max({size.x, size.y, size.z}));
}

}  // namespace deltasplat
