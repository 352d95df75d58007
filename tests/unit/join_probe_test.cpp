// SPDX-License-Identifier: Apache-2.0
#include "words/join_probe.h"

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

constexpr int kAxis = 2;  // of the shapes' slices

// How a pixel's lines of sight pass them.
struct Lines {
    glm::dvec2 shiftPerSlice{0.0};
    bool frontToBack = true;
};

// @param listedAlong  the axis that blocks are listed along
std::optional<JoinedChange> changeOf(const Shape& shape, const Lines& lines,
                                     const JoinedVoxels& joined, int listedAlong = kAxis) {
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
    const JoinProbe probe(listBlocks(*volume.codes(), listedAlong, classes), listedAlong, classes);
    const SightLines all{kAxis, lines.frontToBack, lines.shiftPerSlice, lights};
    return probe.change(joined, [&](const glm::ivec3&) { return all; });
}

// By the channel that changes most.
double gainedBy(const JoinedChange& change) {
    double most = 0;
    for (int c = 0; c < 4; ++c)
        if (std::abs(change.gained[c]) > std::abs(most)) most = change.gained[c];
    return most;
}

double gainedBy(const Shape& shape, const glm::dvec2& shiftPerSlice, int within, int slices = 16) {
    return gainedBy(changeOf(shape, {shiftPerSlice}, {slices, within}).value());
}

Voxel denseIf(bool isDense) {
    return isDense ? Voxel::kDense : Voxel::kNone;
}

// What is even, or lies across the lines of sight, is as dense as it is.
TEST(JoinProbe, isKeptByWhatIsEven) {
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
TEST(JoinProbe, growsWithPlatesAlongTheLinesOfSight) {
    const auto plates = [](int, int u, int) { return denseIf((u & 1) != 0); };
    const auto alongV = [](int, int, int v) { return denseIf((v & 1) != 0); };
    // Of seven slabs the first has one slice.
    const double through = std::pow(0.5, 6) * (1 - 0.5 * 0.875);
    for (const Shape& shape : {Shape(plates), Shape(alongV)}) {
        for (const int within : {2, 4}) {
            const JoinedChange change = changeOf(shape, {{0, 0}}, {16, within}).value();
            EXPECT_NEAR(gainedBy(change), 1 - through / 0.5, 0.01);
            // Some squares lie beside the volume.
            EXPECT_LT(change.rms, gainedBy(change));
            EXPECT_GT(change.rms, 0.9 * gainedBy(change));
        }
    }
    // Threads of one voxel.
    const auto threads = [](int, int u, int v) { return denseIf((u & 3) == 0 && (v & 3) == 1); };
    EXPECT_GT(gainedBy(threads, {0, 0}, 4), 1);
}

// Of a plate that is seen nearly edge-on, a square may see half in one slab and half in the next:
// all of it, which is opaque in truth, hides no more than three quarters.
TEST(JoinProbe, isLostByPlatesThatAreCrossedSlowly) {
    const auto plate = [](int, int u, int) { return denseIf(u == 60); };
    const JoinedChange change = changeOf(plate, {{0.18, 0}}, {16, 2}).value();
    EXPECT_LT(gainedBy(change), -0.02);
    EXPECT_GT(change.rms, 0.01);
    EXPECT_LT(change.rms, 0.25);
    EXPECT_NEAR(gainedBy(plate, {1, 0}, 2), 0, 3e-3);
}

// What goes on for one slab alone, as most things that are crossed do, gains little.
TEST(JoinProbe, growsLittleByWhatDiffersFromSlabToSlab) {
    std::mt19937 random(3);
    std::vector<std::uint8_t> noise(1 << 20);
    for (std::uint8_t& value : noise) value = std::uint8_t(random() & 15);
    const auto any = [&](int s, int u, int v) {
        const int place = (s + 40) * 193 * 181 + (u + 40) * 181 + v + 40;
        return denseIf(noise[std::size_t(place) & (noise.size() - 1)] == 0);
    };
    for (const int within : {2, 4}) EXPECT_LT(std::abs(gainedBy(any, {0.3, -0.7}, within)), 0.004);
}

// Lines of sight that pass a rod of one voxel slowly see it in several slices. Where two become one
// that are not moved along with them, they see less of it, and where these are moved too far, more.
TEST(JoinProbe, isChangedByRodsThatLinesOfSightPassSlowly) {
    const auto rods = [](int, int u, int v) { return denseIf((u & 15) == 3 && (v & 15) == 5); };
    // By whole voxels nothing is moved.
    for (const glm::dvec2 straight : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(-1, 1)}) {
        for (const int slices : {2, 8}) {
            const JoinedChange change = changeOf(rods, {straight}, {slices, 1}).value();
            EXPECT_EQ(gainedBy(change), 0) << straight.x << " " << slices;
            EXPECT_EQ(change.rms, 0) << straight.x << " " << slices;
        }
    }
    // Neither slice moved, and then one along u.
    const JoinedChange apart = changeOf(rods, {{0.497, 0.36}}, {2, 1}).value();
    const JoinedChange moved = changeOf(rods, {{0.505, 0.36}}, {2, 1}).value();
    EXPECT_LT(gainedBy(apart), -0.1);
    EXPECT_GT(gainedBy(moved), 0.1);
    for (const JoinedChange& change : {apart, moved}) EXPECT_GT(change.rms, 0.1);
}

TEST(JoinProbe, growsWithPlatesThatAreSeenEdgeOn) {
    const auto plates = [](int s, int, int v) {
        const int place = v + int(std::floor(0.32 * s));
        return denseIf((place % 10 + 10) % 10 == 0);
    };
    const Lines edgeOn{{-0.214, 0.32}};
    EXPECT_GT(gainedBy(changeOf(plates, edgeOn, {2, 1}).value()), 0.08);
    EXPECT_GT(gainedBy(changeOf(plates, edgeOn, {8, 1}).value()), 0.16);
    EXPECT_LT(std::abs(gainedBy(changeOf(plates, {{-0.214, -0.6}}, {2, 1}).value())), 0.02);
}

// Blocks may be listed along another axis than lines of sight go.
TEST(JoinProbe, doesNotDependOnTheListsAxis) {
    const auto rods = [](int, int u, int v) { return denseIf((u & 15) == 3 && (v & 15) == 5); };
    const double expected = gainedBy(changeOf(rods, {{0.497, 0.36}}, {2, 1}).value());
    for (const int axis : {0, 1})
        EXPECT_NEAR(gainedBy(changeOf(rods, {{0.497, 0.36}}, {2, 1}, axis).value()), expected, 0.08)
            << axis;
    const auto ball = [](int s, int u, int v) {
        return denseIf(std::hypot(s - 14, u - 60, v - 55) < 30);
    };
    for (const int axis : {0, 1, 2})
        EXPECT_LT(std::abs(gainedBy(changeOf(ball, {{0.8, -0.6}}, {8, 1}, axis).value())), 0.01)
            << axis;
}

// Wherever in index space it lies.
TEST(JoinProbe, isTheSameFarAway) {
    std::vector<Slot> classes(kSlotCount, 0);
    classes[8] = 1;
    const std::vector<glm::dvec4> lights = {glm::dvec4(0), {0, 0, 0.875, 0.875}};
    const auto changeAt = [&](const glm::ivec3& place, const JoinedVoxels& joined) {
        const Volume volume =
            test::makeVolume({place, place + glm::ivec3(63, 63, 95)}, [&](int x, int y, int z) {
                const glm::ivec3 at = glm::ivec3(x, y, z) - place;
                return at.x % 16 == 3 && (at.y + at.z / 4) % 8 == 5 ? 7 : test::kInactive;
            });
        const JoinProbe probe(listBlocks(*volume.codes(), kAxis, classes), kAxis, classes);
        const SightLines lines{kAxis, true, {0.5, -0.25}, lights};
        return probe.change(joined, [&](const glm::ivec3&) { return lines; }).value();
    };
    for (const JoinedVoxels& joined : {JoinedVoxels{2, 1}, {16, 2}, {32, 4}}) {
        const JoinedChange expected = changeAt(glm::ivec3(0), joined);
        EXPECT_GT(expected.rms, 0.01);
        for (const glm::ivec3& place :
             {glm::ivec3(1 << 29), glm::ivec3(64 - (1 << 30)), glm::ivec3((1 << 30) - 128),
              glm::ivec3(1 << 29, -(1 << 29), 64)}) {
            const JoinedChange change = changeAt(place, joined);
            EXPECT_NEAR(change.rms, expected.rms, 1e-6);
            EXPECT_NEAR(gainedBy(change), gainedBy(expected), 1e-6);
        }
    }
}

TEST(JoinProbe, isTheSameOnAnyNumberOfThreads) {
    const auto ball = [](int s, int u, int v) {
        return denseIf(std::hypot(s - 14, u - 60, v - 55) < 30);
    };
    const JoinedChange expected = changeOf(ball, {{0.8, -0.6}}, {16, 2}).value();
    EXPECT_LT(std::abs(gainedBy(expected)), 0.01);
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        const JoinedChange change = changeOf(ball, {{0.8, -0.6}}, {16, 2}).value();
        EXPECT_EQ(change.gained, expected.gained);
        EXPECT_EQ(change.rms, expected.rms);
    }
}

// Where all lines of sight end in what is opaque, more may be seen of what lies before it.
TEST(JoinProbe, growsBeforeWhatIsOpaque) {
    const auto shape = [](int s, int u, int v) {
        const bool isThread = (u & 7) == 2 && (v & 7) == 3;
        return s > 50 ? Voxel::kDense : isThread ? Voxel::kThin : Voxel::kNone;
    };
    const JoinedChange before = changeOf(shape, {{0, 0}}, {16, 4}).value();
    const JoinedChange behind = changeOf(shape, {{0, 0}, false}, {16, 4}).value();
    EXPECT_GT(std::abs(gainedBy(before)), 1e-3);
    EXPECT_NEAR(gainedBy(behind), 0, 1e-6);
}

TEST(JoinProbe, isNotKnownOfWhatIsNotThere) {
    EXPECT_FALSE(changeOf([](int, int, int) { return Voxel::kNone; }, {}, {16, 2}));
    // One voxel is found wherever it is.
    const auto one = [](int s, int u, int v) { return denseIf(s == 7 && u == 90 && v == 14); };
    EXPECT_NEAR(gainedBy(one, {0, 0}, 2), 0, 1e-12);
}

}  // namespace
}  // namespace deltasplat
