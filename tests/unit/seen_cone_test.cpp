// SPDX-License-Identifier: Apache-2.0
// Which blocks a region of a picture sees from an eye.
#include "volume/seen_cone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace deltasplat {
namespace {

// Whether a line of sight comes so near to any voxel of a block that it reads it, slice by slice.
bool isNearAny(const SeenCone& cone, const glm::ivec3& block) {
    for (int slice = 8 * block.x; slice < 8 * block.x + 8; ++slice) {
        for (const double within : {-0.5, 0.0, 0.5}) {
            const double away = (slice + within - cone.eye.x) * (cone.frontToBack ? 1 : -1);
            if (away < 0) continue;
            const double reach = cone.reach + cone.reachPerSlice * away;
            bool isNear = true;
            for (int axis = 0; axis < 2; ++axis) {
                const double first = cone.eye[axis + 1] + away * cone.slopeMin[axis] - reach;
                const double last = cone.eye[axis + 1] + away * cone.slopeMax[axis] + reach;
                isNear = isNear && 8 * block[axis + 1] <= last && 8 * block[axis + 1] + 7 >= first;
            }
            if (isNear) return true;
        }
    }
    return false;
}

TEST(SeenCone, seesAllThatALineOfSightReads) {
    std::mt19937 random(4);
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    int near = 0;
    int left = 0;
    for (int i = 0; i < 400; ++i) {
        SeenCone cone;
        cone.eye = {between(-90, 90), between(-90, 90), between(-90, 90)};
        cone.frontToBack = i % 2 == 0;
        for (int axis = 0; axis < 2; ++axis) {
            cone.slopeMin[axis] = between(-1, 0.9);
            cone.slopeMax[axis] = between(cone.slopeMin[axis], 1);
        }
        cone.reach = between(0, 6);
        cone.reachPerSlice = between(0, 0.1);
        for (int j = 0; j < 100; ++j) {
            const glm::ivec3 block(int(between(-12, 12)), int(between(-12, 12)),
                                   int(between(-12, 12)));
            const bool isNear = isNearAny(cone, block);
            EXPECT_TRUE(cone.sees(block) || !isNear);
            near += isNear;
            left += !cone.sees(block);
        }
    }
    // Both are tried, and hardly more is kept than has to be.
    EXPECT_GT(near, 1000);
    EXPECT_GT(left, 0.9 * (40000 - near));
}

TEST(SeenCone, leavesOutWhatLiesBehindTheEye) {
    SeenCone cone;
    cone.slopeMin = {-1, -1};
    cone.slopeMax = {1, 1};
    EXPECT_TRUE(cone.sees({0, 0, 0}));
    EXPECT_FALSE(cone.sees({-2, 0, 0}));
    cone.frontToBack = false;
    EXPECT_TRUE(cone.sees({-2, 0, 0}));
    EXPECT_FALSE(cone.sees({1, 0, 0}));
}

}  // namespace
}  // namespace deltasplat
