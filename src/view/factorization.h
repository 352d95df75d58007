// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// Directions this close are equal. Rounding in a transform or an angle must not choose the axis of
/// a diagonal view, tilt a straight view, or decide how a view is drawn.
inline constexpr double kSnap = 1e-9;

/// Returns the axis most parallel to a direction; the last one of several.
inline int mostParallelAxis(const glm::dvec3& direction) {
    const glm::dvec3 along = glm::abs(direction);
    const double largest = std::max({along.x, along.y, along.z});
    for (int axis = 2; axis > 0; --axis) {
        if (along[axis] >= largest * (1 - kSnap)) return axis;
    }
    return 0;
}

/// Returns the map from divided voxels (slice, u, v) to (x, y, z). Not for joined slices.
inline glm::dmat4 indexFromThinVoxel(int sliceAxis, const Subdivision& parts) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    const glm::dvec3 per(parts.slices, parts.within, parts.within);
    glm::dmat4 indexFromThin(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        indexFromThin[axis][order[axis]] = 1 / per[axis];
        indexFromThin[3][order[axis]] = parts.origin[axis] + 0.5 / per[axis] - 0.5;
    }
    indexFromThin[3][3] = 1;
    return indexFromThin;
}

}  // namespace deltasplat
