// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>

#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// Returns where voxels lie as slices count them, in the index space of a volume's own: from
/// (slice, u, v), of what is divided its parts, to (x, y, z). Not of joined slices.
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
