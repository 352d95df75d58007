// SPDX-License-Identifier: Apache-2.0
// Volumes whose values stay in their file have to compare as those that are read as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/threads.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/write_vdb.h"
#include "unit/convert_helpers.h"
#include "unit/random_grid.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::Inactive;
using testing::randomGrid;
using testing::readKept;
using testing::TempFolder;

ReadOptions keptOptions() {
    ReadOptions options;
    options.keepSource = true;
    options.levelSetToFog = false;
    return options;
}

std::optional<Volume> readPacked(const std::string& file,
                                 const ReadOptions& options = keptOptions(),
                                 const Listener& listener = {}) {
    return readPackedVolume(file, options, listener);
}

void expectSame(const VolumeComparison& a, const VolumeComparison& b) {
    EXPECT_EQ(a.voxels, b.voxels);
    EXPECT_EQ(a.meanError, b.meanError);
    EXPECT_EQ(a.rmsError, b.rmsError);
    EXPECT_EQ(a.maxError, b.maxError);
    EXPECT_EQ(a.maxAt, b.maxAt);
    EXPECT_EQ(a.valueTextA, b.valueTextA);
    EXPECT_EQ(a.valueTextB, b.valueTextB);
    EXPECT_EQ(a.overFail, b.overFail);
    EXPECT_EQ(a.activeMismatch, b.activeMismatch);
    EXPECT_EQ(a.backgroundError, b.backgroundError);
    EXPECT_EQ(a.shift, b.shift);
    EXPECT_EQ(a.equal(), b.equal());
    EXPECT_EQ(a.typeEqual, b.typeEqual);
    EXPECT_EQ(a.classEqual, b.classEqual);
    EXPECT_EQ(a.nameEqual, b.nameEqual);
}

void expectSame(const Volume& packed, const Volume& whole) {
    EXPECT_EQ(packed.name(), whole.name());
    EXPECT_EQ(packed.type(), whole.type());
    EXPECT_EQ(packed.gridClass(), whole.gridClass());
    EXPECT_EQ(packed.background(), whole.background());
    EXPECT_EQ(packed.hasBackground(), whole.hasBackground());
    EXPECT_EQ(packed.activeCount(), whole.activeCount());
    EXPECT_EQ(packed.box(), whole.box());
    EXPECT_EQ(packed.worldFromIndex(), whole.worldFromIndex());
}

void writeOne(const std::string& file, const openvdb::GridBase::ConstPtr& grid) {
    writeVdb(file, {writtenGrid(fromOpenVdb(grid))});
}

// Compares a.vdb with b.vdb packed, whole, and one of each.
void expectSameComparison() {
    const Volume wholeA = readKept("a.vdb");
    const Volume wholeB = readKept("b.vdb");
    const auto packedA = readPacked("a.vdb");
    const auto packedB = readPacked("b.vdb");
    ASSERT_TRUE(packedA && packedB);
    expectSame(*packedA, wholeA);
    expectSame(*packedB, wholeB);
    const VolumeComparison expected = compareVolumes(wholeA, wholeB);
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        expectSame(compareVolumes(*packedA, *packedB), expected);
        expectSame(compareVolumes(*packedA, wholeB), expected);
        expectSame(compareVolumes(wholeA, *packedB), expected);
    }
}

TEST(PackedVolume, ComparesAsAWholeOne) {
    const TempFolder folder;
    unsigned seed = 0;
    for (const Inactive inactive : testing::kAllInactive) {
        SCOPED_TRACE(int(inactive));
        // The same leaves in part: seeds of leaves are those of their values.
        const auto a = randomGrid<openvdb::FloatGrid>(200, inactive, 2, ++seed);
        const auto b = a->deepCopy();
        for (auto value = b->tree().beginValueAll(); value; ++value) {
            if (value.getCoord().z() % 7 == 0) value.setValue(*value + 0.1F);
        }
        b->tree().setValueOn(Coord(5000, 1, 2), 3);
        writeOne("a.vdb", a);
        writeOne("b.vdb", b);
        expectSameComparison();
    }
}

TEST(PackedVolume, OfAllTypesOfNumbers) {
    const TempFolder folder;
    writeOne("a.vdb", randomGrid<openvdb::DoubleGrid>(60, Inactive::kTwo, 0, 1));
    writeOne("b.vdb", randomGrid<openvdb::Int32Grid>(60, Inactive::kMany, 1, 1));
    expectSameComparison();
    const auto wide = randomGrid<openvdb::Int64Grid>(60, Inactive::kBoth, 3, 1);
    wide->tree().setValueOn(Coord(0), std::numeric_limits<std::int64_t>::max() - 1);
    writeOne("a.vdb", wide);
    expectSameComparison();
    wide->tree().setValueOn(Coord(0), std::numeric_limits<std::int64_t>::max());
    wide->tree().root().setBackground((std::int64_t{1} << 60) + 1, false);
    writeOne("b.vdb", wide);
    expectSameComparison();
    const auto half = randomGrid<openvdb::FloatGrid>(60, Inactive::kOneBesideBackground, 0, 1);
    half->setSaveFloatAsHalf(true);
    half->setGridClass(openvdb::GRID_LEVEL_SET);
    writeOne("a.vdb", half);
    expectSameComparison();
}

TEST(PackedVolume, EmptyGridsWarnOnce) {
    const TempFolder folder;
    writeOne("a.vdb", randomGrid<openvdb::FloatGrid>(0, Inactive::kTwo, 0, 1));
    writeOne("b.vdb", randomGrid<openvdb::FloatGrid>(4, Inactive::kTwo, 0, 1));
    expectSameComparison();
    std::vector<std::string> warnings;
    const Listener listener{{}, [&](const std::string& text) { warnings.push_back(text); }};
    ASSERT_TRUE(readPacked("a.vdb", keptOptions(), listener));
    EXPECT_EQ(warnings, std::vector<std::string>{"a.vdb: grid \"grid\": no active voxels"});
}

TEST(PackedVolume, OthersAreReadAsAWhole) {
    const TempFolder folder;
    writeOne("mask.vdb", randomGrid<openvdb::MaskGrid>(4, Inactive::kTwo, 0, 1));
    writeOne("vectors.vdb", randomGrid<openvdb::Vec3SGrid>(4, Inactive::kTwo, 0, 1));
    writeOne("numbers.vdb", randomGrid<openvdb::FloatGrid>(4, Inactive::kTwo, 0, 1));
    EXPECT_FALSE(readPacked("mask.vdb"));
    EXPECT_FALSE(readPacked("missing.vdb"));
    testing::writeBytes("other.vdb", std::string("no .vdb"));
    EXPECT_FALSE(readPacked("other.vdb"));
    ReadOptions options = keptOptions();
    EXPECT_TRUE(readPacked("numbers.vdb", options));
    options.nanValue = 1;
    EXPECT_FALSE(readPacked("numbers.vdb", options));
    options = keptOptions();
    options.levelSetToFog = true;
    EXPECT_FALSE(readPacked("numbers.vdb", options));
    options = keptOptions();
    options.gridName = "grid.x";
    EXPECT_FALSE(readPacked("vectors.vdb", options));
}

TEST(PackedVolume, WhatIsNotFiniteOrElsewhereNeedsTheWholeGrid) {
    const TempFolder folder;
    const auto grid = randomGrid<openvdb::FloatGrid>(4, Inactive::kTwo, 0, 1);
    writeOne("a.vdb", grid);
    const auto moved = grid->deepCopy();
    moved->setTransform(openvdb::math::Transform::createLinearTransform(1));
    moved->transform().postTranslate(openvdb::Vec3d(3, 0, 0));
    writeOne("moved.vdb", moved);
    const auto odd = grid->deepCopy();
    odd->tree().setValueOff(Coord(0, 0, 1), std::numeric_limits<float>::infinity());
    writeOne("b.vdb", odd);
    expectSameComparison();
    odd->tree().setValueOn(Coord(0), std::numeric_limits<float>::quiet_NaN());
    writeOne("leaf.vdb", odd);
    const auto tile = grid->deepCopy();
    tile->tree().addTile(2, Coord(100000, 0, 0), std::numeric_limits<float>::infinity(), true);
    writeOne("tile.vdb", tile);
    const auto a = readPacked("a.vdb");
    ASSERT_TRUE(a);
    std::string bytes = testing::readBytes("a.vdb");
    std::fill(bytes.end() - 60, bytes.end(), '\xff');
    testing::writeBytes("damaged.vdb", bytes);
    for (const char* const other : {"moved.vdb", "leaf.vdb", "tile.vdb", "damaged.vdb"}) {
        const auto b = readPacked(other);
        ASSERT_TRUE(b);
        EXPECT_THROW(compareVolumes(*a, *b), NeedsWholeGrid) << other;
    }
}

}  // namespace
}  // namespace deltasplat
