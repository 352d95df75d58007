// SPDX-License-Identifier: Apache-2.0
#include "rays/sight_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "deltasplat/ingest/slot.h"

namespace deltasplat {
namespace {

// What is within this of a tie, or of straight, is so: rounding neither chooses an axis nor tilts a
// straight view.
constexpr double kRounding = 1e-9;

int mostParallelAxis(const glm::dvec3& ray) {
    int axis = 0;
    for (int other = 1; other < 3; ++other) {
        if (std::abs(ray[other]) >= std::abs(ray[axis]) * (1 - kRounding)) axis = other;
    }
    return axis;
}

double snapped(double slope) {
    return slope < kRounding ? 0 : slope > 1 - kRounding ? 1 : slope;
}

}  // namespace

SightRay::SightRay(const IndexBox& box, const glm::dvec3& through, const glm::dvec3& ray) {
    axes.order = sliceOrder(mostParallelAxis(ray));
    for (int i = 0; i < 3; ++i) {
        const int axis = axes.order[i];
        axes.sign[i] = ray[axis] < 0 ? -1 : 1;
        axes.first[i] = ray[axis] < 0 ? box.max[axis] : box.min[axis];
        axes.count[i] = box.max[axis] - box.min[axis] + 1;
    }
    const double along = std::abs(ray[axes.order[0]]);
    for (int i = 0; i < 2; ++i) slope[i] = snapped(std::abs(ray[axes.order[i + 1]]) / along);
    moveTo(through);
}

void SightRay::moveTo(const glm::dvec3& through) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) {
        const double at = through[axes.order[i]];
        point[i] = axes.sign[i] < 0 ? axes.count[i] - 1 - at : at;
    }
    point_ = point.x;
    start = glm::dvec2(point.y, point.z) - point.x * slope;
    nearest = -std::numeric_limits<double>::infinity();
    clip();
}

void SightRay::beginAt(double slicesFromPoint) {
    nearest = point_ + slicesFromPoint;
    clip();
}

// A voxel is read up to one beside it.
void SightRay::clip() {
    slices = {std::max(nearest, -1.0), axes.count[0]};
    for (int i = 0; i < 2; ++i) {
        const double low = -1 - start[i];
        const double high = axes.count[i + 1] - start[i];
        if (slope[i] > 0) {
            slices.x = std::max(slices.x, low / slope[i]);
            slices.y = std::min(slices.y, high / slope[i]);
        } else if (low >= 0 || high <= 0) {
            slices.y = slices.x - 1;
        }
    }
}

}  // namespace deltasplat
