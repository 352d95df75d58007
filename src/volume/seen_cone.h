// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// What of a volume a picture's region may show from an eye: voxels that lie behind slopes, or so
/// near to these that a pixel reads what they are splatted to. In (slice, u, v) order.
struct SeenCone {
    glm::dvec3 eye{0.0};
    bool frontToBack = true;  ///< increasing slice index goes away from the eye
    /// Slopes along u and v, of which the plane's pixels at its borders have the first and last.
    glm::dvec2 slopeMin{0.0};
    glm::dvec2 slopeMax{0.0};
    /// Voxels around a line of sight that it reads, at most: so many, and so many more for each
    /// slice that it has come.
    double reach = 0;
    double reachPerSlice = 0;

    /// Whether any voxel of a block of 8x8x8 may be seen.
    /// @param block  position of its first voxel, divided by 8
    bool sees(const glm::ivec3& block) const;
    bool operator==(const SeenCone&) const = default;
};

}  // namespace deltasplat
