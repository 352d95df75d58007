// SPDX-License-Identifier: Apache-2.0
// Blocks are listed in the order of columns, whatever thread put them there.
#include "volume/code_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "deltasplat/threads.h"
#include "support/make_volume.h"
#include "volume/code_tree.h"

namespace deltasplat {
namespace {

using Place = std::tuple<int, int, int>;

// Leaves of two codes, in one eighth of which the second is; each block is one or the other.
Volume someBlocks(int dims) {
    return test::makeVolume({{-8, 0, 16}, {dims - 9, dims - 1, dims + 15}},
                            [](int x, int y, int z) {
                                const int block = (x >> 3) * 7 + (y >> 3) * 3 + (z >> 3) * 5;
                                // Of no block all voxels are the same.
                                return block % 8 == 0 ? 200 + (x & 1) : (z & 1) + 100;
                            });
}

TEST(CodeBlocks, AreListedByColumns) {
    // More leaves than are looked at by one thread at a time.
    const Volume volume = someBlocks(200);
    ASSERT_GT(volume.codes()->leaves()->size(), 3u * 4096);
    std::vector<Slot> slots(kSlotCount, kEmptySlot);
    std::fill(slots.begin() + 1 + 200, slots.begin() + 1 + 202, Slot{1});
    for (int axis = 0; axis < 3; ++axis) {
        std::set<Place> expected;
        for (const CodeLeaf& leaf : *volume.codes()->leaves()) {
            const glm::ivec3 at = toSliceOrder(leaf.origin >> 3, axis);
            if (leaf.lowest >= 200) expected.insert({at.y, at.z, at.x});
        }
        ASSERT_GT(expected.size(), 1000u);
        for (const int threads : {1, 3}) {
            const ThreadLimit limit(threads);
            std::vector<Place> listed;
            for (const CodeBlock& block : listBlocks(*volume.codes(), axis, slots)) {
                listed.push_back({block.position.y, block.position.z, block.position.x});
                ASSERT_NE(block.leaf, nullptr);
                EXPECT_EQ(toSliceOrder(block.leaf->origin() >> 3, axis), block.position);
                EXPECT_EQ(block.lowest, 200);
                EXPECT_EQ(block.highest, 201);
            }
            EXPECT_TRUE(std::equal(listed.begin(), listed.end(), expected.begin(), expected.end()))
                << axis << ", " << threads;
        }
    }
}

}  // namespace
}  // namespace deltasplat
