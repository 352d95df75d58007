// SPDX-License-Identifier: Apache-2.0
#include "rays/eye_ray.h"

#include <cmath>
#include <limits>

namespace deltasplat {
namespace {

int mostParallelAxis(const glm::dvec3& ray) {
    int axis = 0;
    for (int other = 1; other < 3; ++other) {
        if (std::abs(ray[other]) >= std::abs(ray[axis])) axis = other;
    }
    return axis;
}

}  // namespace

EyeRay::EyeRay(const glm::dvec3& eyePosition, const glm::dvec3& ray)
    : order(sliceOrder(mostParallelAxis(ray))) {
    const double along = ray[order[0]];
    goesUp = along > 0;
    slices = {0, goesUp ? -1 : 1};
    eye = {eyePosition[order[0]], eyePosition[order[1]], eyePosition[order[2]]};
    slope = glm::dvec2(ray[order[1]], ray[order[2]]) / std::abs(along);
}

void EyeRay::clip(double nearestSlices, const IndexBox& box) {
    nearest = nearestSlices;
    // Distances between which it is in the box, a slice more at each end: what lies beside is found
    // out slice by slice.
    double from = nearest;
    double to = std::numeric_limits<double>::infinity();
    const glm::dvec3 steps(goesUp ? 1 : -1, slope.x, slope.y);
    for (int i = 0; i < 3; ++i) {
        const double low = box.min[order[i]] - 1.0 - eye[i];
        const double high = box.max[order[i]] + 1.0 - eye[i];
        if (steps[i] == 0) {
            if (low > 0 || high < 0) return;
            continue;
        }
        from = std::max(from, (steps[i] > 0 ? low : high) / steps[i]);
        to = std::min(to, (steps[i] > 0 ? high : low) / steps[i]);
    }
    from -= 1;
    to += 1;
    if (!(from <= to)) return;
    const double first = box.min[order[0]];
    const double last = box.max[order[0]];
    const double a = goesUp ? eye.x + from : eye.x - from;
    const double b = goesUp ? eye.x + to : eye.x - to;
    const auto sliceAt = [&](double position) { return int(std::clamp(position, first, last)); };
    slices = goesUp ? glm::ivec2(sliceAt(std::ceil(a)), sliceAt(std::floor(b)))
                    : glm::ivec2(sliceAt(std::floor(a)), sliceAt(std::ceil(b)));
}

}  // namespace deltasplat
