// SPDX-License-Identifier: Apache-2.0
#include "delta/square_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "deltasplat/threads.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// Of voxels (slice, u, v) of 96 slices: blue ones that are opaque but for 1/8, and red ones of a
// hundredth of that.
enum class Voxel { kNone, kDense, kThin };

using Shape = std::function<Voxel(int slice, int u, int v)>;

std::optional<SquareChange> changeOf(const Shape& shape, const glm::dvec2& shiftPerSlice,
                                     int within, bool lastInFront = false) {
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
    const std::vector<glm::dvec4> lights = {
        glm::dvec4(0), {0, 0, 0.875, 0.875}, {0.00875, 0, 0, 0.00875}};
    const ClassReader reader(classes, nullptr, kAxis);
    return squareChange(listBlocks(*volume.codes, kAxis, classes), reader, lights,
                        {shiftPerSlice, lastInFront, 16, within});
}

double gainedBy(const Shape& shape, const glm::dvec2& shiftPerSlice, int within) {
    return changeOf(shape, shiftPerSlice, within).value().gained;
}

Voxel denseIf(bool isDense) {
    return isDense ? Voxel::kDense : Voxel::kNone;
}

// What is even, or lies across the lines of sight, is as dense as it is.
TEST(SquareChange, isKeptByWhatIsEven) {
    for (const int within : {2, 4}) {
        const glm::dvec2 straight(0);
        EXPECT_NEAR(gainedBy([](int, int, int) { return Voxel::kThin; }, straight, within), 0,
                    1e-12);
        // A voxel thick, or a whole number of what becomes one.
        EXPECT_NEAR(gainedBy([](int s, int, int) { return denseIf(s == 5); }, straight, within), 0,
                    1e-12);
        EXPECT_NEAR(
            gainedBy([=](int, int u, int) { return denseIf((u & within) == 0); }, straight, within),
            0, 1e-12);
    }
}

// Each slab lets half of the light through, and then half of that: all of them together as much as
// one in truth.
TEST(SquareChange, growsWithPlatesAlongTheLinesOfSight) {
    const auto plates = [](int, int u, int) { return denseIf((u & 1) != 0); };
    const auto alongV = [](int, int, int v) { return denseIf((v & 1) != 0); };
    // Of seven slabs the first has one slice.
    const double through = std::pow(0.5, 6) * (1 - 0.5 * 0.875);
    for (const Shape& shape : {Shape(plates), Shape(alongV)}) {
        for (const int within : {2, 4}) {
            const SquareChange change = changeOf(shape, {0, 0}, within).value();
            EXPECT_NEAR(change.gained, 1 - through / 0.5, 1e-9);
            // Some squares lie beside the volume.
            EXPECT_LT(change.rms, change.gained);
            EXPECT_GT(change.rms, 0.9 * change.gained);
        }
    }
    // Along slopes as well.
    const auto slanted = [](int s, int u, int) {
        return denseIf(((u + int(std::floor(0.5 * s + 0.5))) & 1) != 0);
    };
    EXPECT_GT(gainedBy(slanted, {0.5, 0}, 2), 0.85);
    EXPECT_LT(gainedBy(slanted, {0, 0}, 2), 0.05);
    // Threads of one voxel.
    const auto threads = [](int, int u, int v) { return denseIf((u & 3) == 0 && (v & 3) == 1); };
    EXPECT_GT(gainedBy(threads, {0, 0}, 4), 1);
}

// Of a plate that is seen nearly edge-on, a square may see half in one slab and half in the next:
// all of it, which is opaque in truth, hides no more than three quarters.
TEST(SquareChange, isLostByPlatesThatAreCrossedSlowly) {
    const auto plate = [](int, int u, int) { return denseIf(u == 60); };
    const SquareChange change = changeOf(plate, {0.18, 0}, 2).value();
    EXPECT_LT(change.gained, -0.02);
    EXPECT_GT(change.rms, 0.01);
    EXPECT_LT(change.rms, 0.25);
    EXPECT_NEAR(gainedBy(plate, {1, 0}, 2), 0, 1e-3);
}

// What goes on for one slab alone, as most things that are crossed do, gains little.
TEST(SquareChange, growsLittleByWhatDiffersFromSlabToSlab) {
    std::mt19937 random(3);
    std::vector<std::uint8_t> noise(1 << 20);
    for (std::uint8_t& value : noise) value = std::uint8_t(random() & 15);
    const auto any = [&](int s, int u, int v) {
        const int place = (s + 40) * 193 * 181 + (u + 40) * 181 + v + 40;
        return denseIf(noise[std::size_t(place) & (noise.size() - 1)] == 0);
    };
    for (const int within : {2, 4}) EXPECT_LT(std::abs(gainedBy(any, {0.3, -0.7}, within)), 0.004);
}

TEST(SquareChange, isTheSameOnAnyNumberOfThreads) {
    const auto ball = [](int s, int u, int v) {
        return denseIf(std::hypot(s - 14, u - 60, v - 55) < 30);
    };
    const SquareChange expected = changeOf(ball, {0.8, -0.6}, 2).value();
    EXPECT_GT(expected.gained, 0);
    EXPECT_LT(expected.gained, 0.02);
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        const SquareChange change = changeOf(ball, {0.8, -0.6}, 2).value();
        EXPECT_EQ(change.gained, expected.gained);
        EXPECT_EQ(change.rms, expected.rms);
    }
}

// Where all lines of sight end in what is opaque, more may be seen of what lies before it.
TEST(SquareChange, growsBeforeWhatIsOpaque) {
    const auto shape = [](int s, int u, int v) {
        const bool isThread = (u & 7) == 2 && (v & 7) == 3;
        return s > 50 ? Voxel::kDense : isThread ? Voxel::kThin : Voxel::kNone;
    };
    const SquareChange before = changeOf(shape, {0, 0}, 4).value();
    const SquareChange behind = changeOf(shape, {0, 0}, 4, true).value();
    EXPECT_GT(std::abs(before.gained), 1e-3);
    EXPECT_NEAR(behind.gained, 0, 1e-6);
}

TEST(SquareChange, isNotKnownOfWhatIsNotThere) {
    EXPECT_FALSE(changeOf([](int, int, int) { return Voxel::kNone; }, {0, 0}, 2));
    // One voxel is found wherever it is.
    const auto one = [](int s, int u, int v) { return denseIf(s == 7 && u == 90 && v == 14); };
    EXPECT_NEAR(gainedBy(one, {0, 0}, 2), 0, 1e-12);
}

}  // namespace
}  // namespace deltasplat
