// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/view/factorization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "base/text.h"
#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

const IndexBox kBox{{0, 0, 0}, {20, 20, 20}};

glm::dmat4 spaced(double x, double y, double z) {
    glm::dmat4 matrix(1);
    matrix[0][0] = x;
    matrix[1][1] = y;
    matrix[2][2] = z;
    return matrix;
}

Factorization factorizationOf(const CameraOptions& options, const glm::dmat4& worldFromIndex) {
    return factorize(makeCamera(options, kBox, worldFromIndex), worldFromIndex);
}

CameraOptions turned(const char* view, double azimuth, double elevation = 0) {
    CameraOptions options;
    options.view = view;
    options.azimuthDegrees = azimuth;
    options.elevationDegrees = elevation;
    return options;
}

glm::dvec3 worldOf(const glm::dmat4& worldFromIndex, const glm::dvec3& index) {
    return glm::dvec3(worldFromIndex * glm::dvec4(index, 1));
}

TEST(Factorization, straightViewsAreExactlyStraight) {
    const struct {
        CameraOptions options;
        int axis;
        bool frontToBack;
    } views[] = {{turned("front", 0), 2, false},  {turned("back", 0), 2, true},
                 {turned("left", 0), 0, true},    {turned("right", 0), 0, false},
                 {turned("top", 0), 1, false},    {turned("bottom", 0), 1, true},
                 {turned("front", 90), 0, false}, {turned("front", 0, -90), 1, true}};
    for (const auto& view : views) {
        SCOPED_TRACE(view.options.view);
        const Factorization f = factorizationOf(view.options, spaced(0.1, 0.2, 0.3));
        EXPECT_EQ(f.sliceAxis, view.axis);
        EXPECT_EQ(f.frontToBack, view.frontToBack);
        EXPECT_EQ(f.shiftPerSlice, glm::dvec2(0));
        EXPECT_NEAR(f.sliceStepWorld, 0.1 * (view.axis + 1), 1e-15);
    }
}

TEST(Factorization, pixelsRunToTheRightAndDownOnTheBasePlane) {
    // Seen from the front, u = x goes to the right and v = y goes up; from the back, x goes left.
    CameraOptions options;
    options.sizePixels = {20, 20};
    const Factorization front = factorizationOf(options, glm::dmat4(1));
    EXPECT_EQ(front.baseFromPixel * glm::dvec3(0, 0, 1), glm::dvec3(0, 20, 1));
    EXPECT_EQ(front.baseFromPixel * glm::dvec3(20, 0, 1), glm::dvec3(20, 20, 1));
    EXPECT_EQ(front.baseFromPixel * glm::dvec3(20, 20, 1), glm::dvec3(20, 0, 1));
    options.view = "back";
    const Factorization back = factorizationOf(options, glm::dmat4(1));
    EXPECT_EQ(back.baseFromPixel * glm::dvec3(0, 0, 1), glm::dvec3(20, 20, 1));
    // From the left, the slice axis is x, so (u, v) = (y, z): z goes to the right and y up.
    options.view = "left";
    const Factorization left = factorizationOf(options, glm::dmat4(1));
    EXPECT_EQ(left.baseFromPixel * glm::dvec3(0, 0, 1), glm::dvec3(20, 0, 1));
    EXPECT_EQ(left.baseFromPixel * glm::dvec3(20, 0, 1), glm::dvec3(20, 20, 1));
}

TEST(Factorization, tiesGoToTheLaterAxis) {
    const Factorization diagonal = factorizationOf(turned("front", 45), glm::dmat4(1));
    EXPECT_EQ(diagonal.sliceAxis, 2);
    EXPECT_EQ(diagonal.shiftPerSlice, glm::dvec2(-1, 0));
    EXPECT_NEAR(diagonal.sliceStepWorld, std::sqrt(2.0), 1e-12);
    EXPECT_EQ(factorizationOf(turned("front", 45.001), glm::dmat4(1)).sliceAxis, 0);
    EXPECT_EQ(factorizationOf(turned("left", 0, 45), glm::dmat4(1)).sliceAxis, 1);

    const Factorization iso = factorizationOf(turned("iso", 0), spaced(0.1, 0.1, 0.1));
    EXPECT_EQ(iso.sliceAxis, 2);
    EXPECT_EQ(iso.shiftPerSlice, glm::dvec2(-1, -1));
    EXPECT_NEAR(iso.sliceStepWorld, 0.1 * std::sqrt(3.0), 1e-12);

    // Voxels four times as long along z: the line of sight crosses more slices of x and y.
    const Factorization flat = factorizationOf(turned("iso", 0), spaced(1, 1, 4));
    EXPECT_EQ(flat.sliceAxis, 1);
    EXPECT_EQ(flat.shiftPerSlice, glm::dvec2(-0.25, -1));
}

TEST(Factorization, stepGrowsWithTheAngle) {
    for (const double degrees : {0.0, 20.0, 44.0}) {
        const Factorization f = factorizationOf(turned("front", degrees), spaced(7, 7, 7));
        EXPECT_NEAR(f.sliceStepWorld, 7 / std::cos(degrees * std::acos(-1.0) / 180), 1e-12);
        EXPECT_NEAR(f.shiftPerSlice.x, -std::tan(degrees * std::acos(-1.0) / 180), 1e-12);
    }
}

TEST(Factorization, agreesWithProjectingVoxelsOneByOne) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    int axes[3] = {0, 0, 0};
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE(i);
        glm::dmat4 worldFromIndex(1);
        for (int column = 0; column < 3; ++column) {
            worldFromIndex[column] = glm::dvec4(vector(), 0);
            worldFromIndex[column][column] += number(random) < 0 ? -2 : 2;
        }
        worldFromIndex[3] = glm::dvec4(1000.0 * vector(), 1);
        CameraOptions options;
        options.direction = vector();
        options.rollDegrees = 180 * number(random);
        options.sizePixels = {320, 200};
        const Camera camera = makeCamera(options, kBox, worldFromIndex);
        const Factorization f = factorize(camera, worldFromIndex);
        const glm::ivec3 order = sliceOrder(f.sliceAxis);
        ++axes[f.sliceAxis];
        EXPECT_LE(std::abs(f.shiftPerSlice.x), 1);
        EXPECT_LE(std::abs(f.shiftPerSlice.y), 1);

        // A voxel's pixel, taken to the base plane, is where the shift says that it falls.
        const glm::dvec3 index(20 * number(random), 20 * number(random), 20 * number(random));
        const glm::dvec3 world = worldOf(worldFromIndex, index);
        const glm::dvec3 base = f.baseFromPixel * glm::dvec3(camera.pixelFromWorld(world), 1);
        const glm::dvec2 expected =
            glm::dvec2(index[order[1]], index[order[2]]) + index[order[0]] * f.shiftPerSlice;
        EXPECT_LE(glm::distance(glm::dvec2(base), expected), 1e-7);
        EXPECT_EQ(base.z, 1);

        // One slice further along the line of sight lies one step further from the camera.
        glm::dvec3 next = index;
        next[order[0]] += 1;
        next[order[1]] -= f.shiftPerSlice.x;
        next[order[2]] -= f.shiftPerSlice.y;
        const glm::dvec3 step = worldOf(worldFromIndex, next) - world;
        const double sign = f.frontToBack ? 1 : -1;
        EXPECT_LE(glm::distance(step, sign * f.sliceStepWorld * camera.direction), 1e-7);
    }
    for (const int count : axes) EXPECT_GT(count, 50);
}

TEST(Factorization, wholeLinesOfSightFallOnOnePoint) {
    const glm::dmat4 worldFromIndex = spaced(1, 1, 2);
    CameraOptions options;
    options.direction = glm::dvec3(1, -2, 6);
    const Factorization f = factorizationOf(options, worldFromIndex);
    ASSERT_EQ(f.sliceAxis, 2);
    // Index direction (1, -2, 3): from one slice to the next u grows by 1/3 and v falls by 2/3.
    for (int s = 0; s <= 18; s += 3) {
        const glm::dvec2 base = glm::dvec2(2 + s / 3, 15 - 2 * s / 3) + double(s) * f.shiftPerSlice;
        EXPECT_LE(glm::distance(base, glm::dvec2(2, 15)), 1e-12) << s;
    }
}

TEST(Factorization, resolutionFollowsTheScreen) {
    const struct {
        double pixelsPerVoxel;
        double resolution;
    } cases[] = {{0.01, 1}, {1, 1}, {1.4, 1}, {1.6, 2}, {3.4, 2}, {50, 2}};
    for (const auto& c : cases) {
        CameraOptions options;
        options.sizePixels = {1000, 500};
        options.frameWidthWorld = 1000 / c.pixelsPerVoxel;
        EXPECT_EQ(factorizationOf(options, glm::dmat4(1)).resolution, c.resolution)
            << c.pixelsPerVoxel;
    }
    // Voxels twice as long one way count by their longer side on the screen.
    CameraOptions options;
    options.frameWidthWorld = 512;
    EXPECT_EQ(factorizationOf(options, spaced(1, 2, 1)).resolution, 2);
    EXPECT_EQ(factorizationOf(options, spaced(2, 1, 1)).resolution, 2);

    const Camera camera = makeCamera(options, kBox, glm::dmat4(1));
    EXPECT_EQ(factorize(camera, glm::dmat4(1), 16).resolution, 16);
}

TEST(Factorization, resolutionIsTheLargestStretchOfARotatedScreen) {
    // Seen at 44 degrees, base plane u is shortened on the screen and v is not.
    CameraOptions options = turned("front", 44);
    options.frameWidthWorld = 512 / 1.7;
    options.rollDegrees = 33;
    EXPECT_EQ(factorizationOf(options, glm::dmat4(1)).resolution, 2);
}

// From an eye each line of sight belongs to one region, whose slopes and steps hold its own.
TEST(Factorization, regionsAtSlopeStepsShareOutAllLinesOfSight) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 40; ++i) {
        CameraOptions options = turned("front", 29 * i, 17 * i % 60);
        const bool isPanorama = i % 5 == 4;
        options.projection = isPanorama ? Projection::kLatlong : Projection::kPerspective;
        options.sizePixels = isPanorama ? glm::ivec2(64, 32) : glm::ivec2(60, 40);
        if (!isPanorama) options.fovDegrees = 10 + 3 * i;
        const glm::dmat4 worldFromIndex = spaced(1, 0.7, i % 3 == 0 ? 4 : 1.3);
        const Camera camera = makeCamera(options, kBox, worldFromIndex);
        const auto regions = factorizeRegions(camera, kBox, worldFromIndex, {}, true);
        for (const Factorization& region : regions) {
            EXPECT_GE(region.steps, 1);
            EXPECT_GE(region.stepRange, 1);
        }
        for (int j = 0; j < 200; ++j) {
            const glm::dvec2 pixel =
                glm::dvec2(share(random), share(random)) * glm::dvec2(options.sizePixels);
            const glm::dvec3 ray = camera.rayThrough(pixel);
            int found = 0;
            for (const Factorization& region : regions) {
                const glm::dvec3 steps = glm::inverse(region.worldFromStep) * ray;
                ASSERT_TRUE(region.slopeStep);
                if (!belongs(steps, sliceOrder(region.sliceAxis)) ||
                    !isNearSlope(region.slopeStep->x, steps.y, steps.x) ||
                    !isNearSlope(region.slopeStep->y, steps.z, steps.x))
                    continue;
                ++found;
                const glm::dvec2 slope = glm::dvec2(steps.y, steps.z) / steps.x;
                for (int axis = 0; axis < 2; ++axis) {
                    EXPECT_GE(slope[axis], region.slopeMin[axis] - 1e-9);
                    EXPECT_LE(slope[axis], region.slopeMax[axis] + 1e-9);
                }
                const double length = glm::length(region.worldFromStep * glm::dvec3(1, slope));
                const double times = length / (region.steps * region.sliceStepWorld);
                EXPECT_LE(std::max(times, 1 / times), region.stepRange + 1e-9);
            }
            EXPECT_EQ(found, 1) << i << ": " << pixel.x << ", " << pixel.y;
        }
    }
    EXPECT_TRUE(isNearSlope(0, 0.5, 1) && isNearSlope(0, -0.5, 1));
    EXPECT_FALSE(isNearSlope(1, 0.5, 1) || isNearSlope(-1, -0.5, 1));
    EXPECT_TRUE(isNearSlope(1, 0.51, 1) && isNearSlope(-1, -1, 1));
}

// Nothing of a volume covers more pixels than is said: against where cameras see it.
TEST(Factorization, lengthsCoverNoMorePixelsThanIsSaid) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> share(-1, 1);
    for (int i = 0; i < 30; ++i) {
        CameraOptions options = turned("front", 37 * i, 13 * i % 70);
        options.projection = Projection::kPerspective;
        options.fovDegrees = 10 + 2 * i;
        options.frameOffset = {0.1 * (i % 4), 0};
        options.pixelAspect = i % 2 == 0 ? 1 : 1.5;
        const glm::dmat4 worldFromIndex = spaced(1, 0.7, 1.3);
        const Camera camera = makeCamera(options, kBox, worldFromIndex);
        constexpr double kLength = 0.01;
        const double most = mostPixelsOf(kLength, camera, kBox, worldFromIndex);
        if (std::isinf(most)) continue;
        double covered = 0;
        for (int j = 0; j < 500; ++j) {
            const glm::dvec3 index =
                10.0 + 10.4 * glm::dvec3(share(random), share(random), share(random));
            const glm::dvec3 at = worldOf(worldFromIndex, index);
            const glm::dvec2 pixel = camera.pixelFromWorld(at);
            if (pixel != glm::clamp(pixel, glm::dvec2(0), glm::dvec2(camera.sizePixels))) continue;
            const glm::dvec3 way =
                glm::normalize(glm::dvec3(share(random), share(random), share(random)));
            covered =
                std::max(covered, glm::length(camera.pixelFromWorld(at + kLength * way) - pixel));
        }
        EXPECT_LE(covered, most * 1.01);
        EXPECT_GT(covered, most * 0.2);
    }
    // Within, and behind the near plane.
    CameraOptions near = turned("front", 0);
    near.projection = Projection::kPerspective;
    near.distanceWorld = 12;
    const auto pixelsOf = [&] {
        return mostPixelsOf(1, makeCamera(near, kBox, spaced(1, 1, 1)), kBox, spaced(1, 1, 1));
    };
    EXPECT_TRUE(std::isfinite(pixelsOf()));
    near.nearWorld = 3;
    EXPECT_TRUE(std::isinf(pixelsOf()));
    near.nearWorld = 0;
    near.distanceWorld = 8;
    EXPECT_TRUE(std::isinf(pixelsOf()));
}

TEST(Factorization, refusesResolutionsOutOfRangeAndFlatWorlds) {
    const Camera camera = makeCamera(CameraOptions(), kBox, glm::dmat4(1));
    for (const double resolution : {0.0, -1.0, 17.0, 1.5, 0.3, 0.0625}) {
        try {
            factorize(camera, glm::dmat4(1), resolution);
            ADD_FAILURE() << resolution;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            EXPECT_EQ(std::string(error.what()), "`resolution`: got " + numberText(resolution) +
                                                     "; expected a whole number within 1..16");
        }
    }
    try {
        factorize(camera, spaced(1, 0, 1));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
    }
}

}  // namespace
}  // namespace deltasplat
