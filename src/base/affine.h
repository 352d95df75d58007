// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/index_box.h"
#include "deltasplat/view/world_box.h"

namespace deltasplat {

/// Refuses a transform that cannot be inverted.
/// @throw Error(kInput) if an entry is not finite or voxels have no volume
void requireInvertible(const glm::dmat4& worldFromIndex);

/// Returns a corner of a box, the centre of a voxel.
/// @param number  0..7: bits 0, 1 and 2 choose the largest x, y and z
inline glm::dvec3 cornerOf(const IndexBox& box, int number) {
    return {number & 1 ? box.max.x : box.min.x, number & 2 ? box.max.y : box.min.y,
            number & 4 ? box.max.z : box.min.z};
}

/// Returns the smallest box that holds two boxes. Either may be empty.
inline IndexBox boxOfBoth(const IndexBox& a, const IndexBox& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

/// Returns the smallest box in the world that holds the centres of all voxels of a box; for an
/// empty box, the centre of voxel (0, 0, 0).
WorldBox worldBox(const IndexBox& box, const glm::dmat4& worldFromIndex);

/// Returns a vector's direction, of length 1, even where the vector's square is too large or too
/// small for a number.
/// @param v  finite, not 0
inline glm::dvec3 unitVectorOf(const glm::dvec3& v) {
    const glm::dvec3 size = glm::abs(v);
    return glm::normalize(v / std::max({size.x, size.y, size.z}));
}

}  // namespace deltasplat
