// SPDX-License-Identifier: Apache-2.0
#include "view/base_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace deltasplat {
namespace {

// How far places of slices, moved by slants, lie from each other.
double rangeOf(const JoinedSlants& joined, int count, double shift, int axis) {
    double least = 0;
    double most = 0;
    for (int i = 1; i < count; ++i) {
        const double place = i * shift - joined.slants[std::size_t(i)][axis];
        least = std::min(least, place);
        most = std::max(most, place);
    }
    return most - least;
}

// Of all ways to move each slice by a whole number of voxels.
double leastRange(double shift, int count) {
    double least = 1;
    for (int begin = 0; begin < 1000; ++begin) {
        double lowest = 2;
        double highest = -2;
        for (int i = 0; i < count; ++i) {
            const double place = i * shift - begin * 1e-3;
            lowest = std::min(lowest, place - std::floor(place));
            highest = std::max(highest, place - std::floor(place));
        }
        least = std::min(least, highest - lowest);
    }
    return least;
}

TEST(JoinedSlants, keepSlicesAsNearToTheirPlacesAsTheyCanBe) {
    for (const int count : {2, 4, 8, 16, kMostJoined}) {
        for (int i = -400; i <= 400; ++i) {
            const glm::dvec2 shift(i / 400.0, -i / 531.0);
            const JoinedSlants joined = joinedSlants(shift, count);
            glm::dvec2 range;
            for (int axis = 0; axis < 2; ++axis) {
                range[axis] = rangeOf(joined, count, shift[axis], axis);
                EXPECT_LE(range[axis], 1 - 1.0 / count + 1e-9);
                EXPECT_LE(range[axis], leastRange(shift[axis], count) + 2e-3) << shift[axis];
                EXPECT_EQ(joined.slants[0][axis], 0);
                for (int k = 0; k < count; ++k) {
                    const int slant = joined.slants[std::size_t(k)][axis];
                    EXPECT_LE(std::abs(slant), k);
                    EXPECT_GE(slant * shift[axis], 0);
                }
            }
            EXPECT_NEAR(joined.farthest, 0.5 * glm::length(range), 1e-12);
        }
    }
}

TEST(JoinedSlants, areRoundedShiftsOfPairs) {
    for (int i = -1000; i <= 1000; ++i) {
        const double shift = i / 1000.0 * (1 - 1e-9);
        EXPECT_EQ(joinedSlants({shift, 0}, 2).slants[1].x, std::lround(shift)) << shift;
    }
}

TEST(JoinedSlants, moveNothingStraightOrAlongDiagonals) {
    for (const int count : {2, 4, 8, 16, kMostJoined}) {
        for (const double shift : {0.0, 1.0, -1.0}) {
            const JoinedSlants joined = joinedSlants({shift, 0}, count);
            EXPECT_LT(joined.farthest, 1e-9);
            for (int k = 0; k < count; ++k)
                EXPECT_EQ(joined.slants[std::size_t(k)].x, int(shift) * k);
        }
    }
}

}  // namespace
}  // namespace deltasplat
