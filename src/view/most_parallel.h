// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Directions this close are the same: rounding in a transform or an angle must neither choose the
/// axis of a diagonal view, nor tilt a straight one, nor decide how one is drawn.
inline constexpr double kSnap = 1e-9;

/// Returns the axis that a direction is most parallel to, of several the last.
inline int mostParallelAxis(const glm::dvec3& direction) {
    const glm::dvec3 along = glm::abs(direction);
    const double largest = std::max({along.x, along.y, along.z});
    for (int axis = 2; axis > 0; --axis) {
        if (along[axis] >= largest * (1 - kSnap)) return axis;
    }
    return 0;
}

}  // namespace deltasplat
