// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "deltasplat/delta/stamp_counts.h"
#include "deltasplat/threads.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

const std::vector<IndexBox>& boxes() {
    static const std::vector<IndexBox> kBoxes = {{{0, 0, 0}, {0, 0, 0}},
                                                 {{0, 0, 0}, {16, 7, 8}},
                                                 {{-9, -17, -3}, {8, 4, 12}},
                                                 {{5, -20, 100}, {30, -2, 140}}};
    return kBoxes;
}

// Every third code cannot be seen, and four at a time look alike.
std::vector<Slot> someSlotMap() {
    std::vector<Slot> slotMap(kSlotCount, kEmptySlot);
    for (Slot slot = 1; slot < kSlotCount; ++slot) {
        if (slot % 3 != 0) slotMap[slot] = std::max(1, slot & ~3);
    }
    return slotMap;
}

Slot slotAt(const Volume& volume, const glm::ivec3& p, std::span<const Slot> slotMap) {
    Code code = 0;
    const bool active = volume.codes()->tree().probeValue(openvdb::Coord(p.x, p.y, p.z), code);
    if (!active) return kEmptySlot;
    return slotMap.empty() ? code + 1 : slotMap[code + 1];
}

// Counts voxel by voxel, each slice against the one before; in front of the first there is nothing.
std::vector<SliceCounts> countPlainly(const Volume& volume, int axis,
                                      std::span<const Slot> slotMap) {
    const IndexBox& box = volume.box();
    std::vector<SliceCounts> counts(box.dims()[axis]);
    for (int x = box.min.x; x <= box.max.x; ++x) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            for (int z = box.min.z; z <= box.max.z; ++z) {
                const glm::ivec3 p(x, y, z);
                glm::ivec3 before = p;
                --before[axis];
                const int slice = p[axis] - box.min[axis];
                const Slot slot = slotAt(volume, p, slotMap);
                const Slot last = slice > 0 ? slotAt(volume, before, slotMap) : kEmptySlot;
                counts[slice].visible += slot != kEmptySlot;
                counts[slice].deltas += slot != last;
            }
        }
    }
    return counts;
}

void expectSame(const std::vector<SliceCounts>& got, const std::vector<SliceCounts>& expected) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].visible, expected[i].visible) << "slice " << i;
        EXPECT_EQ(got[i].deltas, expected[i].deltas) << "slice " << i;
    }
}

TEST(SliceCounts, AreThoseOfEveryVoxelLookedAt) {
    const std::vector<Slot> slotMap = someSlotMap();
    for (std::size_t b = 0; b < boxes().size(); ++b) {
        const Volume volume = test::randomVolume(boxes()[b], std::uint32_t(b + 1));
        for (int axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE("box " + std::to_string(b) + ", axis " + std::to_string(axis));
            expectSame(countDeltasPerSlice(volume, axis), countPlainly(volume, axis, {}));
            expectSame(countDeltasPerSlice(volume, axis, slotMap),
                       countPlainly(volume, axis, slotMap));
        }
    }
}

TEST(SliceCounts, AddUpToThoseOfTheVolume) {
    const std::vector<Slot> slotMap = someSlotMap();
    const Volume volume = test::randomVolume(boxes()[3], 21);
    for (int axis = 0; axis < 3; ++axis) {
        SliceCounts sum;
        for (const SliceCounts& slice : countDeltasPerSlice(volume, axis, slotMap)) {
            sum.visible += slice.visible;
            sum.deltas += slice.deltas;
        }
        const SliceCounts whole = countDeltas(volume, axis, slotMap);
        EXPECT_EQ(sum.visible, whole.visible);
        EXPECT_EQ(sum.deltas, whole.deltas);
    }
}

TEST(SliceCounts, SeveralSlicesAreTheSumOfEach) {
    const Volume volume = test::randomVolume(boxes()[3], 22);
    const std::vector<SliceCounts> slices = countDeltasPerSlice(volume, 2);
    for (const int each : {2, 7, 41, 1000}) {
        std::vector<SliceCounts> expected((slices.size() + each - 1) / each);
        for (std::size_t i = 0; i < slices.size(); ++i) {
            expected[i / each].visible += slices[i].visible;
            expected[i / each].deltas += slices[i].deltas;
        }
        SCOPED_TRACE(std::to_string(each) + " slices each");
        expectSame(countDeltasPerSlice(volume, 2, {}, each), expected);
    }
}

TEST(SliceCounts, WhatEndsBetweenBlocksIsTakenAwayBehindIt) {
    // Slices 0 to 7 are full, the others empty but for the last one.
    const Volume volume = test::makeVolume({{0, 0, 0}, {3, 3, 30}}, [](int, int, int z) {
        return z < 8 || z == 30 ? 5 : test::kInactive;
    });
    const std::vector<SliceCounts> slices = countDeltasPerSlice(volume, 2);
    for (int z = 0; z < 31; ++z) {
        EXPECT_EQ(slices[z].visible, z < 8 || z == 30 ? 16u : 0u) << z;
        EXPECT_EQ(slices[z].deltas, z == 0 || z == 8 || z == 30 ? 16u : 0u) << z;
    }
}

TEST(SliceCounts, VoxelsFarApartTakeNoMemory) {
    constexpr int kFar = (1 << 30) - 1;
    auto tree = std::make_shared<CodeTree>();
    tree->tree().setValueOn(openvdb::Coord(-kFar, 0, 0), Code{1});
    tree->tree().setValueOn(openvdb::Coord(kFar, 0, 0), Code{1});
    VolumeData volume;
    volume.codes = tree;
    volume.activeCount = 2;
    volume.box = {{-kFar, 0, 0}, {kFar, 0, 0}};
    const std::vector<SliceCounts> counts = countDeltasPerSlice(Volume(volume), 0, {}, 1 << 28);
    ASSERT_EQ(counts.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(counts[i].visible, i == 0 || i == 7 ? 1u : 0u) << i;
        // The first voxel comes and goes, behind the last one there is no slice.
        EXPECT_EQ(counts[i].deltas, i == 0 ? 2u : i == 7 ? 1u : 0u) << i;
    }
}

TEST(SliceCounts, SameOnEveryNumberOfThreads) {
    const Volume volume = test::randomVolume({{-20, -20, -20}, {40, 40, 40}}, 11);
    const auto counts = [&](int threads) {
        const ThreadLimit limit(threads);
        return countDeltasPerSlice(volume, 1);
    };
    expectSame(counts(1), counts(2));
}

TEST(SliceCounts, EmptyVolumeHasNone) {
    VolumeData volume;
    volume.codes = std::make_shared<CodeTree>();
    EXPECT_TRUE(countDeltasPerSlice(Volume(volume), 0).empty());
    EXPECT_EQ(predictStamps(Volume(volume), 0).automatic, 0u);
}

TEST(StampCounts, KnownInClosedForm) {
    // Slices 0 to 7 never change; 8 to 15 change everywhere and are a quarter full; of 16 to 23,
    // five eighths change.
    const Volume volume = test::makeVolume({{0, 0, 0}, {7, 7, 23}}, [](int x, int y, int z) {
        if (z < 8) return 40;
        if (z >= 16) return x < 5 ? 50 + z % 2 : 50;
        return (x + y + z) % 4 == 0 ? 7 : test::kInactive;
    });
    const StampCounts stamps = predictStamps(volume, 2);
    EXPECT_EQ(stamps.traditional, 8u * 8 * 24);
    EXPECT_EQ(stamps.sparse, 8u * 64 + 8 * 16 + 8 * 64);
    // Key slices of 64, 16 and 64; of the second slab 16 voxels go and 16 come in 7 slices.
    EXPECT_EQ(stamps.delta, 64u + 16 + 7 * 32 + 64 + 7 * 40);
    EXPECT_EQ(stamps.automatic, 64u + 8 * 16 + 64 + 7 * 40);
}

TEST(StampCounts, OneValueCanBeMadeEmpty) {
    const Volume volume =
        test::makeVolume({{0, 0, 0}, {3, 3, 0}}, [](int x, int, int) { return x < 3 ? 9 : 10; });
    const std::vector<Slot> slots = slotsWithout(volume.codeBook(), 9);
    EXPECT_EQ(slots[0], kEmptySlot);
    EXPECT_EQ(slots[9 + 1], kEmptySlot);
    EXPECT_EQ(slots[10 + 1], 10 + 1);
    EXPECT_EQ(predictStamps(volume, 2, slots).sparse, 4u);
    // A value that no code stands for hides nothing.
    EXPECT_EQ(predictStamps(volume, 2, slotsWithout(volume.codeBook(), 9.5)).sparse, 16u);
}

}  // namespace
}  // namespace deltasplat
