// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/cut/cut_volume.h"

namespace deltasplat {

/// A clip plane as voxels see it: how far beyond it, on the side that is kept, a place lies, in
/// widths of a voxel's box along the normal.
struct IndexPlane {
    glm::dvec3 slope{0.0};
    double offset = 0;

    /// Rises with each index whose slope is positive, in floating point as well.
    double distanceAt(const glm::dvec3& posIndex) const {
        return slope.x * posIndex.x + slope.y * posIndex.y + slope.z * posIndex.z + offset;
    }
    /// Returns about which share 0..1 of a voxel's box lies on the side that is kept: exactly where
    /// the normal is along an axis of the volume.
    double keptShare(const glm::dvec3& posIndex) const {
        return std::clamp(0.5 + distanceAt(posIndex), 0.0, 1.0);
    }
};

/// Voxels that are off by rounding alone are kept.
inline constexpr double kCutRounding = 1e-6;

/// @param plane  of a normal other than 0
IndexPlane indexPlane(const ClipPlane& plane, const glm::dmat4& worldFromIndex);

}  // namespace deltasplat
