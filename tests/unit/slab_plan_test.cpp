// SPDX-License-Identifier: Apache-2.0
#include "words/slab_plan.h"

#include <gtest/gtest.h>

namespace deltasplat {
namespace {

void add(SlabPlanner& planner, int slice, std::uint64_t visible, std::uint64_t changed) {
    planner.add(slice, {&visible, 1}, {&changed, 1});
}

// A planner that has counted `visible` voxels a slice, of which `changed` differ from the slice
// before; in the first slice all do.
SlabPlanner planned(int firstSlice, int slices, int visible, int changed) {
    const auto mask = [](int count) {
        return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    };
    SlabPlanner planner({{firstSlice, 0, 0}, {firstSlice + slices - 1, 7, 7}});
    for (int i = 0; i < slices; ++i)
        add(planner, firstSlice + i, mask(visible), mask(i == 0 ? visible : changed));
    return planner;
}

// Whether the last slab of such a planner of 16 slices is whole.
bool isWhole(int visible, int changed, Encoding encoding) {
    return planned(0, 16, visible, changed).plan(encoding).slabs.back().whole;
}

std::size_t slabCount(int slices, int visible, int changed) {
    return planned(0, slices, visible, changed).plan(Encoding::kChanges).slabs.size();
}

TEST(SlabPlan, HasEightSlabsWhereKeySlicesCostLittle) {
    EXPECT_EQ(slabCount(128, 20, 20), 8u);
    EXPECT_EQ(slabCount(225, 20, 20), 8u);
    EXPECT_EQ(slabCount(1024, 64, 64), 8u);
    EXPECT_EQ(slabCount(30, 20, 20), 4u);  // no fewer than eight slices each
    EXPECT_EQ(slabCount(1, 1, 0), 1u);
}

TEST(SlabPlan, HasNoMoreWhereTheyBeginBetweenBlocks) {
    for (const int first : {-1, -5, 3, 7}) {
        for (const int slices : {1, 57, 64, 128, 129, 1000}) {
            EXPECT_LE(planned(first, slices, 20, 20).plan(Encoding::kChanges).slabs.size(), 8u);
        }
    }
}

TEST(SlabPlan, HasFewerWhereTheyCostMuch) {
    EXPECT_EQ(slabCount(128, 60, 2), 4u);
    EXPECT_EQ(slabCount(225, 60, 2), 4u);
    EXPECT_EQ(slabCount(1024, 60, 2), 4u);
    EXPECT_EQ(slabCount(30, 60, 2), 1u);
    EXPECT_EQ(slabCount(64, 60, 2), 2u);
}

TEST(SlabPlan, IsTheSameForEveryEncodingButForWhatIsWhole) {
    const SlabPlanner planner = planned(-5, 200, 60, 2);
    const SlabPlan changes = planner.plan(Encoding::kChanges);
    for (const Encoding encoding : {Encoding::kWhole, Encoding::kFewerWordsOrStamps}) {
        const SlabPlan plan = planner.plan(encoding);
        ASSERT_EQ(plan.slabs.size(), changes.slabs.size());
        for (std::size_t i = 0; i < plan.slabs.size(); ++i) {
            EXPECT_EQ(plan.slabs[i].firstSlice, changes.slabs[i].firstSlice);
            EXPECT_EQ(plan.slabs[i].deltas, changes.slabs[i].deltas);
            EXPECT_EQ(plan.slabs[i].whole, encoding == Encoding::kWhole);
            EXPECT_FALSE(changes.slabs[i].whole);
        }
    }
}

TEST(SlabPlan, CoversTheBoxAndCountsKeySlices) {
    const SlabPlan plan = planned(-5, 200, 60, 58).plan(Encoding::kChanges);
    int next = -5;
    for (const PlannedSlab& slab : plan.slabs) {
        EXPECT_EQ(slab.firstSlice, next);
        EXPECT_TRUE(next == -5 || next % 8 == 0) << next;
        EXPECT_EQ(slab.visible, 60u * slab.sliceCount);
        EXPECT_EQ(slab.deltas, 60u + 58 * (slab.sliceCount - 1));
        next += slab.sliceCount;
    }
    EXPECT_EQ(next, 195);
}

TEST(SlabPlan, TakesWhatIsLessForEachSlab) {
    // The first half never changes; of the other, all voxels of a quarter go and come.
    SlabPlanner planner({{0, 0, 0}, {15, 7, 7}});
    constexpr std::uint64_t kQuarter = 0x1111111111111111;
    for (int slice = 0; slice < 16; ++slice) {
        const std::uint64_t visible = slice < 8 ? ~std::uint64_t{0} : kQuarter << slice % 4;
        const std::uint64_t changed = slice == 0   ? visible
                                      : slice < 8  ? 0
                                      : slice == 8 ? ~kQuarter
                                                   : visible | kQuarter << (slice - 1) % 4;
        add(planner, slice, visible, changed);
    }
    const SlabPlan plan = planner.plan(Encoding::kFewerWordsOrStamps);
    ASSERT_EQ(plan.slabs.size(), 2u);
    EXPECT_FALSE(plan.slabs[0].whole);
    EXPECT_TRUE(plan.slabs[1].whole);
    EXPECT_EQ(plan.slabs[0].deltas, 64u);
    EXPECT_EQ(plan.slabs[1].visible, 128u);
}

TEST(SlabPlan, TakesChangesOfFewVoxelsUnlessWholeSlicesSaveMuch) {
    EXPECT_FALSE(isWhole(5, 7, Encoding::kFewerWordsOrStamps));
    EXPECT_TRUE(isWhole(5, 9, Encoding::kFewerWordsOrStamps));
    EXPECT_FALSE(isWhole(60, 5, Encoding::kFewerWordsOrStamps));
    EXPECT_TRUE(isWhole(60, 5, Encoding::kFewerWords));
    EXPECT_TRUE(isWhole(5, 7, Encoding::kFewerWords));
    for (const Encoding encoding : {Encoding::kFewerWords, Encoding::kFewerWordsOrStamps}) {
        EXPECT_TRUE(isWhole(20, 28, encoding));
        EXPECT_TRUE(isWhole(60, 15, encoding));
        EXPECT_FALSE(isWhole(20, 0, encoding));
    }
}

TEST(SlabPlan, TakesChangesThatSaveASeventhOfTheVoxelsWhereTheseAreWritten) {
    constexpr Encoding kEncoding = Encoding::kFewerWordsOrVoxels;
    EXPECT_TRUE(isWhole(48, 41, kEncoding));   // 384 voxels, 335 of changes and the key slice
    EXPECT_FALSE(isWhole(48, 40, kEncoding));  // 328
    EXPECT_FALSE(isWhole(48, 0, kEncoding));
}

TEST(SlabPlan, TakesChangesThatSaveAQuarterOfTheWritingOfWholeRows) {
    constexpr Encoding kEncoding = Encoding::kFewerWordsOrWrites;
    // Rows of eight voxels: 192 of whole slices, 150 of changes and the key slice.
    EXPECT_TRUE(isWhole(64, 48, kEncoding));
    EXPECT_FALSE(isWhole(64, 40, kEncoding));  // 129
    EXPECT_FALSE(isWhole(64, 0, kEncoding));
    // Single voxels: 24 to 3 and 2 a slice.
    EXPECT_TRUE(isWhole(3, 3, kEncoding));
    EXPECT_FALSE(isWhole(3, 2, kEncoding));
}

TEST(SlabPlan, TakesChangesThatSaveATenthOfTheWords) {
    // Of 80 full blocks, some do not change from slice to slice.
    const auto isWhole = [](int unchanged) {
        SlabPlanner planner({{0, 0, 0}, {7, 7, 639}});
        for (int block = 0; block < 80; ++block)
            for (int slice = 0; slice < 8; ++slice)
                add(planner, slice, ~std::uint64_t{0},
                    block < unchanged && slice > 0 ? 0 : ~std::uint64_t{0});
        return planner.plan(Encoding::kFewerWords).slabs.front().whole;
    };
    EXPECT_TRUE(isWhole(0));
    EXPECT_TRUE(isWhole(9));    // 640 words, 577 of changes
    EXPECT_FALSE(isWhole(10));  // 570
}

TEST(SlabPlan, TakesWholeSlicesWhereTheyHaveNoMoreWords) {
    // A block that is full and never changes, and one in which a voxel goes and comes: there is a
    // word of each slice but those after the first of the former.
    SlabPlanner planner({{0, 0, 0}, {15, 7, 15}});
    for (int slice = 0; slice < 16; ++slice) {
        add(planner, slice, ~std::uint64_t{0}, slice == 0 ? ~std::uint64_t{0} : 0);
        add(planner, slice, slice % 2, 1);
    }
    const SlabPlan plan = planner.plan(Encoding::kFewerWords);
    for (const PlannedSlab& slab : plan.slabs) {
        const auto slices = std::uint64_t(slab.sliceCount);
        EXPECT_EQ(slab.seenWords, slices + slices / 2);
        // One that does not begin with a visible voxel has no word of it in its key slice.
        EXPECT_EQ(slab.words, slab.firstSlice == 0 ? slices + 1 : slices);
        EXPECT_FALSE(slab.whole);
    }
    // Where all words change, whole slices are as good.
    for (const PlannedSlab& slab : planned(0, 16, 20, 3).plan(Encoding::kFewerWords).slabs)
        EXPECT_TRUE(slab.whole);
}

}  // namespace
}  // namespace deltasplat
