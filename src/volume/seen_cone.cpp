// SPDX-License-Identifier: Apache-2.0
#include "volume/seen_cone.h"

#include <algorithm>

namespace deltasplat {

bool SeenCone::sees(const glm::ivec3& block) const {
    // A slice covers half a slice before and behind it. One more is for rounding.
    constexpr double kSlices = 1.5;
    const glm::dvec3 first = 8.0 * glm::dvec3(block) - eye;
    const double least = frontToBack ? first.x - kSlices : -(first.x + 7 + kSlices);
    const double farthest = least + 7 + 2 * kSlices;
    if (farthest < 0) return false;
    const double nearest = std::max(least, 0.0);
    const double around = reach + reachPerSlice * farthest;
    for (int axis = 0; axis < 2; ++axis) {
        const double from = std::min(nearest * slopeMin[axis], farthest * slopeMin[axis]) - around;
        const double to = std::max(nearest * slopeMax[axis], farthest * slopeMax[axis]) + around;
        if (first[axis + 1] > to || first[axis + 1] + 7 < from) return false;
    }
    return true;
}

}  // namespace deltasplat
