// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "deltasplat/threads.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// Of voxels (slice, u, v) of 96 slices, which are opaque but for 1/8, or a hundredth as much.
enum class Voxel { kNone, kDense, kThin };

using Shape = std::function<Voxel(int slice, int u, int v)>;

DensityChange changeOf(const Shape& shape, const JoinedSquares& squares) {
    constexpr int kAxis = 2;
    const glm::ivec3 order = sliceOrder(kAxis);
    // Its sides lie between what becomes one.
    const Volume volume =
        test::makeVolume({{-12, -8, -33}, {131, 119, 62}}, [&](int x, int y, int z) {
            const glm::ivec3 at(x, y, z);
            const Voxel voxel = shape(at[order[0]], at[order[1]], at[order[2]]);
            return voxel == Voxel::kNone ? test::kInactive : voxel == Voxel::kDense ? 7 : 3;
        });
    std::vector<Slot> classes(kSlotCount, 0);
    classes[8] = 1;
    classes[4] = 2;
    const std::vector<double> alphas = {0, 0.875, 0.00875};
    const ClassReader reader(classes, nullptr, kAxis);
    return densityChange(listBlocks(*volume.codes, kAxis, classes), reader, alphas, squares);
}

double gainedBy(const Shape& shape, const JoinedSquares& squares) {
    return changeOf(shape, squares).gained;
}

Voxel denseIf(bool isDense) {
    return isDense ? Voxel::kDense : Voxel::kNone;
}

// What is even, or lies across the lines of sight, is as dense as it is.
TEST(JoinedDensity, isKeptByWhatIsEven) {
    for (const int within : {2, 4}) {
        const JoinedSquares squares{{0, 0}, 16, within};
        EXPECT_NEAR(gainedBy([](int, int, int) { return Voxel::kThin; }, squares), 0, 1e-12);
        // A voxel thick, or a whole number of what becomes one.
        EXPECT_NEAR(gainedBy([](int s, int, int) { return denseIf(s == 5); }, squares), 0, 1e-12);
        EXPECT_NEAR(gainedBy([=](int, int u, int) { return denseIf((u & within) == 0); }, squares),
                    0, 1e-12);
    }
}

// Each slab lets half of the light through, and then half of that: all of them together as much as
// one in truth.
TEST(JoinedDensity, growsWithPlatesAlongTheLinesOfSight) {
    const auto plates = [](int, int u, int) { return denseIf((u & 1) != 0); };
    const auto alongV = [](int, int, int v) { return denseIf((v & 1) != 0); };
    // Of seven slabs the first has one slice.
    const double through = std::pow(0.5, 6) * (1 - 0.5 * 0.875);
    for (const Shape& shape : {Shape(plates), Shape(alongV)}) {
        for (const int within : {2, 4}) {
            const DensityChange change = changeOf(shape, {{0, 0}, 16, within});
            EXPECT_NEAR(change.gained, 1 - through / 0.5, 1e-9);
            // Of lines between whole blocks some pass the volume by.
            EXPECT_NEAR(change.rms, 0.97 * (0.5 - through), 0.03 * (0.5 - through));
        }
    }
    // Along slopes as well.
    const auto slanted = [](int s, int u, int) {
        return denseIf(((u + int(std::floor(0.5 * s + 0.5))) & 1) != 0);
    };
    EXPECT_GT(gainedBy(slanted, {{0.5, 0}, 16, 2}), 0.85);
    EXPECT_LT(gainedBy(slanted, {{0, 0}, 16, 2}), 0.05);
    // Threads of one voxel.
    const auto threads = [](int, int u, int v) { return denseIf((u & 3) == 0 && (v & 3) == 1); };
    EXPECT_GT(gainedBy(threads, {{0, 0}, 16, 4}), 1);
}

// Of a plate that is seen nearly edge-on, a square may see half in one slab and half in the next:
// all of it, which is opaque in truth, hides no more than three quarters.
TEST(JoinedDensity, isLostByPlatesThatAreCrossedSlowly) {
    const auto plate = [](int, int u, int) { return denseIf(u == 60); };
    const DensityChange change = changeOf(plate, {{0.18, 0}, 16, 2});
    EXPECT_LT(change.gained, -0.02);
    EXPECT_GT(change.rms, 0.01);
    EXPECT_LT(change.rms, 0.25);
    EXPECT_NEAR(changeOf(plate, {{1, 0}, 16, 2}).gained, 0, 1e-3);
}

// What goes on for one slab alone, as most things that are crossed do, gains little.
TEST(JoinedDensity, growsLittleByWhatDiffersFromSlabToSlab) {
    std::mt19937 random(3);
    std::vector<std::uint8_t> noise(1 << 20);
    for (std::uint8_t& value : noise) value = std::uint8_t(random() & 15);
    const auto any = [&](int s, int u, int v) {
        const int place = (s + 40) * 193 * 181 + (u + 40) * 181 + v + 40;
        return denseIf(noise[std::size_t(place) & (noise.size() - 1)] == 0);
    };
    for (const int within : {2, 4})
        EXPECT_LT(std::abs(gainedBy(any, {{0.3, -0.7}, 16, within})), 0.004);
}

TEST(JoinedDensity, isTheSameOnAnyNumberOfThreads) {
    const auto ball = [](int s, int u, int v) {
        return denseIf(std::hypot(s - 14, u - 60, v - 55) < 30);
    };
    const JoinedSquares squares{{0.8, -0.6}, 16, 2};
    const double expected = gainedBy(ball, squares);
    EXPECT_GT(expected, 0);
    EXPECT_LT(expected, 0.02);
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(gainedBy(ball, squares), expected);
    }
    EXPECT_EQ(gainedBy([](int, int, int) { return Voxel::kNone; }, squares), 0);
}

}  // namespace
}  // namespace deltasplat
