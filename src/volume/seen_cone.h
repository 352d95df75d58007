// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// The part of a volume that an eye may see in a region of the picture, in (slice, u, v) order.
/// Voxels just outside of the slopes belong to the cone if their footprints reach its pixels.
struct SeenCone {
    glm::dvec3 eye{0.0};
    bool frontToBack = true;  ///< increasing slice index goes away from the eye
    /// Slopes of the first and the last pixel of the picture plane along u and v.
    glm::dvec2 slopeMin{0.0};
    glm::dvec2 slopeMax{0.0};
    /// Voxels beside a line of sight that it reads, at most; more for each slice from the eye.
    double reach = 0;
    double reachPerSlice = 0;

    /// Whether any voxel of an 8x8x8 block may be seen.
    /// @param block  position of its first voxel, divided by 8
    bool sees(const glm::ivec3& block) const;
    bool operator==(const SeenCone&) const = default;
};

}  // namespace deltasplat
