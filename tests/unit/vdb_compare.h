// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace deltasplat::testing {

/// A grid's metadata as text, without what every writer sets anew.
inline std::map<std::string, std::string> metadataOf(const openvdb::MetaMap& metadata) {
    using openvdb::GridBase;
    std::map<std::string, std::string> texts;
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
        texts[entry->first] = entry->second->typeName() + " " + entry->second->str();
    }
    for (const char* const key :
         {GridBase::META_FILE_BBOX_MIN, GridBase::META_FILE_BBOX_MAX,
          GridBase::META_FILE_COMPRESSION, GridBase::META_FILE_MEM_BYTES,
          GridBase::META_FILE_VOXEL_COUNT, GridBase::META_SAVE_HALF_FLOAT}) {
        texts.erase(key);
    }
    return texts;
}

template <typename T>
bool sameValue(T a, T b) {
    return a == b || (a != a && b != b);
}

/// How many voxels and tiles, inactive ones included, differ in value or state.
template <typename Tree>
std::uint64_t countDifferences(const Tree& a, const Tree& b) {
    std::uint64_t count = 0;
    auto other = b.cbeginValueAll();
    for (auto value = a.cbeginValueAll(); value; ++value, ++other) {
        if (!other) return count + 1;
        const bool same = sameValue(*value, *other) && value.isValueOn() == other.isValueOn() &&
                          value.getCoord() == other.getCoord() &&
                          value.getLevel() == other.getLevel();
        if (!same) ++count;
    }
    return other ? count + 1 : count;
}

/// Compares everything that two scalar grids hold.
inline void expectSameGrid(const openvdb::GridBase& a, const openvdb::GridBase& b) {
    using openvdb::GridBase;
    ASSERT_EQ(a.type(), b.type());
    EXPECT_EQ(metadataOf(a), metadataOf(b));
    EXPECT_EQ(a.getName(), b.getName());
    EXPECT_EQ(a.getGridClass(), b.getGridClass());
    EXPECT_EQ(a.transform(), b.transform());
    EXPECT_EQ(a.transform().mapType(), b.transform().mapType());
    EXPECT_EQ(a.activeVoxelCount(), b.activeVoxelCount());
    using Scalars = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid>;
    const bool scalar = a.apply<Scalars>([&](const auto& typed) {
        using Grid = std::decay_t<decltype(typed)>;
        const auto& other = dynamic_cast<const Grid&>(b);
        EXPECT_TRUE(sameValue(typed.background(), other.background()));
        ASSERT_TRUE(typed.constTree().hasSameTopology(other.constTree()));
        EXPECT_EQ(countDifferences(typed.constTree(), other.constTree()), 0u);
    });
    EXPECT_TRUE(scalar);
}

}  // namespace deltasplat::testing
