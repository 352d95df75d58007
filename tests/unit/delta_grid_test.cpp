// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/delta_grid.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "formats/delta/delta_grid.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

using Voxel = std::tuple<int, int, int>;  // slice, u, v
using SlotMap = std::map<Voxel, Slot>;

// Slots of all voxels that are not empty, straight from the volume.
SlotMap slotsOf(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {}) {
    SlotMap slots;
    const glm::ivec3 order = sliceOrder(sliceAxis);
    for (auto voxel = volume.codes()->tree().cbeginValueOn(); voxel; ++voxel) {
        const openvdb::CoordBBox box = voxel.getBoundingBox();
        for (auto c = box.begin(); c; ++c) {
            const Slot slot = slotMap.empty() ? *voxel + 1 : slotMap[*voxel + 1];
            if (slot != kEmptySlot) {
                slots[{(*c)[order[0]], (*c)[order[1]], (*c)[order[2]]}] = slot;
            }
        }
    }
    return slots;
}

// Adds up deltas slab by slab, through OpenVDB's accessor alone.
SlotMap sumOfDeltas(const DeltaGrid& grid) {
    SlotMap slots;
    const openvdb::tree::ValueAccessor<const openvdb::Int32Tree> accessor(*grid.tree->deltas);
    const IndexBox& box = grid.box;
    for (const Slab& slab : grid.slabs) {
        for (int u = box.min.y; u <= box.max.y; ++u) {
            for (int v = box.min.z; v <= box.max.z; ++v) {
                Slot slot = kEmptySlot;
                for (int s = slab.firstSlice; s < slab.firstSlice + slab.sliceCount; ++s) {
                    const Slot value = accessor.getValue(openvdb::Coord(s, u, v));
                    slot += value;
                    if (slot != kEmptySlot) slots[{s, u, v}] = slot;
                }
            }
        }
    }
    return slots;
}

const std::vector<IndexBox>& boxes() {
    static const std::vector<IndexBox> kBoxes = {{{0, 0, 0}, {0, 0, 0}},
                                                 {{0, 0, 0}, {16, 7, 8}},
                                                 {{-9, -17, -3}, {8, 4, 12}},
                                                 {{5, -20, 100}, {30, -2, 111}}};
    return kBoxes;
}

TEST(DeltaGrid, SumOfDeltasGivesBackTheVolume) {
    for (std::size_t b = 0; b < boxes().size(); ++b) {
        const Volume volume = test::randomVolume(boxes()[b], std::uint32_t(b));
        for (int axis = 0; axis < 3; ++axis) {
            const DeltaGrid grid = makeDeltaGrid(volume, {axis, 8, {}});
            EXPECT_EQ(sumOfDeltas(grid), slotsOf(volume, axis)) << b << " axis " << axis;
            EXPECT_EQ(grid.visible(), volume.activeCount());
        }
    }
}

TEST(DeltaGrid, ActiveVoxelsAreExactlyTheChanges) {
    const Volume volume = test::randomVolume(boxes()[2], 7);
    const SlotMap slots = slotsOf(volume, 1);
    const DeltaGrid grid = makeDeltaGrid(volume, {1, 8, {}});
    const auto slotAt = [&](int s, int u, int v) {
        const auto found = slots.find({s, u, v});
        return found == slots.end() ? kEmptySlot : found->second;
    };
    std::uint64_t changes = 0;
    const openvdb::tree::ValueAccessor<const openvdb::Int32Tree> accessor(*grid.tree->deltas);
    for (int s = grid.box.min.x; s <= grid.box.max.x; ++s) {
        for (int u = grid.box.min.y; u <= grid.box.max.y; ++u) {
            for (int v = grid.box.min.z; v <= grid.box.max.z; ++v) {
                const Slot before = s % 8 == 0 ? kEmptySlot : slotAt(s - 1, u, v);
                const bool changed = slotAt(s, u, v) != before;
                EXPECT_EQ(accessor.isValueOn(openvdb::Coord(s, u, v)), changed);
                changes += changed;
            }
        }
    }
    EXPECT_EQ(grid.deltas(), changes);
    EXPECT_EQ(grid.tree->deltas->activeVoxelCount(), changes);
}

TEST(DeltaGrid, TilesCountAsTheirVoxels) {
    auto tree = std::make_shared<CodeTree>();
    tree->tree().addTile(1, openvdb::Coord(0, 0, 0), Code{5}, true);
    tree->tree().addTile(2, openvdb::Coord(128, 0, -128), Code{9}, true);
    tree->tree().setValueOn(openvdb::Coord(8, 0, 0), Code{5});
    VolumeData volume;
    volume.codes = tree;
    volume.activeCount = 512 + 128 * 128 * 128 + 1;
    volume.box = {{0, 0, -128}, {255, 127, 7}};
    for (int axis = 0; axis < 3; ++axis) {
        const DeltaGrid grid = makeDeltaGrid(Volume(volume), {axis, 64, {}});
        EXPECT_EQ(sumOfDeltas(grid), slotsOf(Volume(volume), axis)) << "axis " << axis;
    }
    // Along x: 64 + 128 * 128 enter at key slices only, 64 - 1 leave after x = 7 and the last one
    // after x = 8.
    const SliceCounts counts = countDeltas(Volume(volume), 0);
    EXPECT_EQ(counts.visible, volume.activeCount);
    EXPECT_EQ(counts.deltas, 64 + 63 + 1 + 128 * 128);
}

// Files hold leaves of which every voxel is inactive, anywhere.
TEST(DeltaGrid, LeavesWithoutActiveVoxelsCountForNothing) {
    Volume volume = test::randomVolume(boxes()[2], 5);
    const Volume plain = volume;
    const auto codes = std::make_shared<CodeTree>(std::in_place, plain.codes()->tree());
    for (const openvdb::Coord& far : {openvdb::Coord(-900, 3, 500), openvdb::Coord(4, 700, -88),
                                      openvdb::Coord(2000, -300, 0)}) {
        codes->tree().setValueOn(far, 7);
        codes->tree().setActiveState(far, false);
    }
    ASSERT_EQ(codes->tree().leafCount(), plain.codes()->tree().leafCount() + 3);
    test::changed(volume)->codes = codes;
    for (int axis = 0; axis < 3; ++axis) {
        const DeltaGrid grid = makeDeltaGrid(volume, {axis, 8, {}});
        const DeltaGrid expected = makeDeltaGrid(plain, {axis, 8, {}});
        EXPECT_EQ(sumOfDeltas(grid), slotsOf(plain, axis));
        EXPECT_EQ(grid.tree->deltas->leafCount(), expected.tree->deltas->leafCount());
        EXPECT_EQ(grid.deltas(), expected.deltas());
        EXPECT_EQ(countDeltas(volume, axis).deltas, countDeltas(plain, axis).deltas);
    }
}

TEST(DeltaGrid, SlotMapMergesAndHides) {
    const Volume volume = test::randomVolume(boxes()[1], 3);
    std::vector<Slot> slotMap(kSlotCount, 0);
    for (Slot slot = 1; slot < kSlotCount; ++slot) slotMap[slot] = slot <= 100 ? 0 : slot & ~15;
    for (int axis = 0; axis < 3; ++axis) {
        const DeltaGrid grid = makeDeltaGrid(volume, {axis, 8, slotMap});
        EXPECT_EQ(sumOfDeltas(grid), slotsOf(volume, axis, slotMap));
        const DeltaGrid plain = makeDeltaGrid(volume, {axis, 8, {}});
        EXPECT_LT(grid.deltas(), plain.deltas());
    }
}

TEST(DeltaGrid, SlabsCoverTheBoxAndStartAtMultiplesOfEight) {
    const Volume volume = test::randomVolume({{-9, 0, 0}, {30, 3, 3}}, 1);
    const DeltaGrid grid = makeDeltaGrid(volume, {0, 16, {}});
    int next = -9;
    for (const Slab& slab : grid.slabs) {
        EXPECT_EQ(slab.firstSlice, next);
        EXPECT_TRUE(next == -9 || next % 8 == 0) << next;
        next += slab.sliceCount;
    }
    EXPECT_EQ(next, 31);
    EXPECT_EQ(grid.slabs.size(), 3u);
}

TEST(DeltaGrid, SameOnEveryNumberOfThreads) {
    const Volume volume = test::randomVolume({{-20, -20, -20}, {40, 40, 40}}, 11);
    const auto grid = [&](int threads) {
        const ThreadLimit limit(threads);
        return sumOfDeltas(makeDeltaGrid(volume, {2, 16, {}}));
    };
    EXPECT_EQ(grid(1), grid(2));
}

TEST(DeltaGrid, EmptyVolumeHasNoSlabs) {
    VolumeData volume;
    volume.codes = std::make_shared<CodeTree>();
    EXPECT_TRUE(makeDeltaGrid(Volume(volume), {}).slabs.empty());
    EXPECT_EQ(countDeltas(Volume(volume), 0).deltas, 0u);
}

TEST(DeltaGrid, RefusesKeyIntervalsThatCutLeaves) {
    const Volume volume = test::randomVolume(boxes()[1], 3);
    for (const int interval : {-8, 1, 12}) {
        try {
            makeDeltaGrid(volume, {2, interval, {}});
            FAIL() << interval;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            EXPECT_EQ(std::string(error.what()), "key interval: got " + std::to_string(interval) +
                                                     "; expected a positive multiple of 8");
        }
    }
}

TEST(DeltaGrid, DefaultKeyIntervalDependsOnSlicesAlone) {
    EXPECT_EQ(defaultKeyInterval(1), 128);
    EXPECT_EQ(defaultKeyInterval(512), 128);
    EXPECT_EQ(defaultKeyInterval(2048), 128);
    EXPECT_EQ(defaultKeyInterval(2049), 136);
    EXPECT_EQ(defaultKeyInterval(100000), 6256);
}

}  // namespace
}  // namespace deltasplat
