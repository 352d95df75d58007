// SPDX-License-Identifier: Apache-2.0
#include "rays/line_group.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace deltasplat {

void LineGroup::addSlices(const glm::dvec2& slices) {
    slices_ = {std::min(slices_.x, slices.x), std::max(slices_.y, slices.y)};
}

void LineGroup::addLine(const glm::dvec2& start, const glm::dvec2& slope) {
    const auto add = [&](Range& range, double slice) {
        range.low = glm::min(range.low, start + slice * slope);
        range.high = glm::max(range.high, start + slice * slope);
    };
    add(first_, slices_.x - 1);
    add(last_, slices_.y + 1);
}

// The smallest of linear functions lies above the straight line between its ends, the largest
// below.
LineGroup::Range LineGroup::rangeAt(double slice) const {
    const double way = std::clamp((slice - slices_.x + 1) / (slices_.y - slices_.x + 2), 0.0, 1.0);
    return {glm::mix(first_.low, last_.low, way), glm::mix(first_.high, last_.high, way)};
}

float LineGroup::topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const {
    // Rounding puts no line into a voxel that is not looked at.
    constexpr double kRounding = 1e-6;
    const glm::dvec2 from = rangeAt(layer.slices.x - 1).low - kRounding;
    const glm::dvec2 to = rangeAt(layer.slices.y + 1).high + kRounding + 1.0;
    glm::ivec3 low(0), high(0);
    low[axes.order[0]] = high[axes.order[0]] = layer.block;
    for (int i = 1; i < 3; ++i) {
        const double last = axes.count[i];
        if (to[i - 1] < 0 || from[i - 1] > last) return -std::numeric_limits<float>::infinity();
        const int a = axes.voxelAt(i, int(std::floor(std::max(from[i - 1], 0.0)))) >> 3;
        const int b = axes.voxelAt(i, int(std::floor(std::min(to[i - 1], last)))) >> 3;
        low[axes.order[i]] = std::min(a, b);
        high[axes.order[i]] = std::max(a, b);
    }
    return tops.topBetween(low, high);
}

}  // namespace deltasplat
