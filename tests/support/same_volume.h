// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "deltasplat/ingest/volume.h"
#include "volume/code_tree.h"
#include "volume/tree_types.h"

namespace deltasplat::test {

/// Expects that two volumes say the same of themselves; their codes are not looked at.
inline void expectSameFacts(const Volume& a, const Volume& b) {
    EXPECT_EQ(a.name(), b.name());
    EXPECT_EQ(a.type(), b.type());
    EXPECT_EQ(a.gridClass(), b.gridClass());
    EXPECT_EQ(a.hasBackground(), b.hasBackground());
    EXPECT_EQ(a.background(), b.background());
    EXPECT_EQ(a.box(), b.box());
    EXPECT_EQ(a.worldFromIndex(), b.worldFromIndex());
    EXPECT_EQ(a.codeBook().name(), b.codeBook().name());
    ASSERT_EQ(bool(a.codeBook().table), bool(b.codeBook().table));
    if (a.codeBook().table) {
        EXPECT_EQ(*a.codeBook().table, *b.codeBook().table);
    }
    EXPECT_EQ(a.codeError().absolute, b.codeError().absolute);
    EXPECT_EQ(a.activeCount(), b.activeCount());
    EXPECT_EQ(a.histogram(), b.histogram());
    EXPECT_EQ(a.valueMin(), b.valueMin());
    EXPECT_EQ(a.valueMax(), b.valueMax());
    ASSERT_EQ(a.mostFrequent().has_value(), b.mostFrequent().has_value());
    if (a.mostFrequent()) {
        EXPECT_EQ(a.mostFrequent()->value, b.mostFrequent()->value);
        EXPECT_EQ(a.mostFrequent()->count, b.mostFrequent()->count);
    }
}

/// Expects the same codes in the same active voxels. Makes trees of volumes that have none.
inline void expectSameCodes(const Volume& a, const Volume& b) {
    const CodeTree::Tree& p = a.codes()->tree();
    const CodeTree::Tree& q = b.codes()->tree();
    EXPECT_EQ(p.activeVoxelCount(), q.activeVoxelCount());
    openvdb::CoordBBox box;
    if (!p.evalActiveVoxelBoundingBox(box)) return;
    std::uint64_t wrong = 0;
    const openvdb::tree::ValueAccessor<const CodeTree::Tree> here(p), there(q);
    for (auto at = box.begin(); at; ++at) {
        Code codes[2] = {};
        const bool isOn = here.probeValue(*at, codes[0]);
        const bool isOnThere = there.probeValue(*at, codes[1]);
        wrong += isOn == isOnThere && (!isOn || codes[0] == codes[1]) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
}

inline void expectSameVolume(const Volume& a, const Volume& b) {
    expectSameFacts(a, b);
    expectSameCodes(a, b);
}

}  // namespace deltasplat::test
