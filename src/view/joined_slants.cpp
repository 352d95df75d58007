// SPDX-License-Identifier: Apache-2.0
#include "view/joined_slants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "view/factorization.h"

namespace deltasplat {
namespace {

// What rounding may have done to a sum of a few shifts.
constexpr double kSame = 1e-12;

double partOf(double x) {
    return x - std::floor(x);
}

// Returns where the shortest interval begins, around the circle of what places leave of whole
// numbers, that has all of them: behind the widest gap. Of equal ones, 0 if it can be.
double beginOfShortest(double shift, int count) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i) places.push_back(partOf(i * shift));
    std::sort(places.begin(), places.end());
    double begin = 0;
    double widest = 1 - places.back();
    for (std::size_t i = 1; i < places.size(); ++i) {
        const double gap = places[i] - places[i - 1];
        if (gap <= widest + kSame) continue;
        widest = gap;
        begin = places[i];
    }
    return begin;
}

}  // namespace

JoinedSlants joinedSlants(const glm::dvec2& shiftPerSlice, int count, int within) {
    JoinedSlants joined;
    glm::dvec2 range(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        const double whole = std::abs(shiftPerSlice[axis]);
        const double shift = whole * (1 - kSnap);
        const double begin = beginOfShortest(shift, count);
        const auto wholeOf = [&](int i) { return int(std::floor(i * shift - begin + kSame)); };
        double least = 0;
        double most = 0;
        for (int i = 1; i < count; ++i) {
            const int slant = wholeOf(i) - wholeOf(0);
            joined.slants[std::size_t(i)][axis] = shiftPerSlice[axis] < 0 ? -slant : slant;
            least = std::min(least, i * whole - slant);
            most = std::max(most, i * whole - slant);
        }
        range[axis] = most - least;
        // Else what lies beside a joined voxel is seen through its reading alone, which takes the
        // more of it the farther its slices are off: up to a tenth with four, a fifth with eight.
        constexpr double kHardly = 0.2;
        const bool goesOn = count * shift >= within || (count - 1) * shift <= kHardly;
        joined.keepsDensity = joined.keepsDensity && goesOn;
    }
    joined.farthest = 0.5 * glm::length(range);
    return joined;
}

glm::dvec2 middleOfJoined(const glm::dvec2& shiftPerSlice, std::span<const glm::ivec2> slants) {
    glm::dvec2 least(0.0);
    glm::dvec2 most(0.0);
    for (std::size_t i = 1; i < slants.size(); ++i) {
        const glm::dvec2 place = double(i) * shiftPerSlice - glm::dvec2(slants[i]);
        least = glm::min(least, place);
        most = glm::max(most, place);
    }
    return 0.5 * (least + most);
}

}  // namespace deltasplat
