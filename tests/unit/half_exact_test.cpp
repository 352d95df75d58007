// SPDX-License-Identifier: Apache-2.0
// Grids that survive half precision are written, read by OpenVDB and compared; those that are said
// not to survive are shown to lose something.
#include "formats/vdb/volume_grid.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "formats/vdb/write_vdb.h"
#include "unit/convert_helpers.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::readGrid;

openvdb::FloatGrid::Ptr gridOf(float background, std::initializer_list<float> active,
                               std::initializer_list<float> inactive) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(background);
    int x = 0;
    for (const float value : active) grid->tree().setValueOn(Coord(x++, 0, 0), value);
    x = 0;
    for (const float value : inactive) {
        grid->tree().setValueOff(Coord(x++, 1, 0), value);
    }
    return grid;
}

// Whether every voxel of the first leaf comes back from a file in half precision.
bool comesBack(const openvdb::FloatGrid::Ptr& grid) {
    const testing::TempFolder folder;
    grid->setSaveFloatAsHalf(true);
    writeVdb("half.vdb", {writtenGrid(fromOpenVdb(grid))});
    const auto back = readGrid<openvdb::FloatGrid>("half.vdb");
    bool same = back->background() == grid->background();
    for (int x = 0; x < 8; ++x) {
        for (int y = 0; y < 8; ++y) {
            const Coord place(x, y, 0);
            same = same && back->tree().getValue(place) == grid->tree().getValue(place) &&
                   back->tree().isValueOn(place) == grid->tree().isValueOn(place);
        }
    }
    return same;
}

void expectSurvival(bool expected, const openvdb::FloatGrid::Ptr& grid) {
    EXPECT_EQ(survivesHalf(fromOpenVdb(grid)), expected);
    EXPECT_EQ(comesBack(grid), expected);
}

TEST(HalfExact, ActiveValues) {
    expectSurvival(true, gridOf(0, {0.5F, 2048, 65504, -0.25F, 0x1p-24F}, {}));
    expectSurvival(false, gridOf(0, {0.5F, 2049}, {}));
    expectSurvival(false, gridOf(0, {0.1F}, {}));
    expectSurvival(false, gridOf(0, {65536}, {}));
    expectSurvival(false, gridOf(0, {0x1p-25F}, {}));
}

TEST(HalfExact, Background) {
    expectSurvival(true, gridOf(0.125F, {0.5F}, {}));
    expectSurvival(true, gridOf(0.125F, {0.5F}, {0.125F, -0.125F}));
    expectSurvival(false, gridOf(0.1F, {0.5F}, {}));
    expectSurvival(false, gridOf(0.1F, {0.5F}, {0.1F, -0.1F}));
}

TEST(HalfExact, InactiveValues) {
    expectSurvival(true, gridOf(0, {0.5F}, {1, 2, 3, -7}));
    expectSurvival(false, gridOf(0, {0.5F}, {0.1F}));
    expectSurvival(false, gridOf(0, {0.5F}, {1, 2, 0.1F}));
}

TEST(HalfExact, Tiles) {
    const auto grid = gridOf(0, {0.5F}, {});
    grid->tree().addTile(1, Coord(64, 0, 0), 0.25F, true);
    EXPECT_TRUE(survivesHalf(fromOpenVdb(grid)));
    grid->tree().addTile(1, Coord(128, 0, 0), 0.1F, true);
    EXPECT_FALSE(survivesHalf(fromOpenVdb(grid)));
}

TEST(HalfExact, OnlyRealGrids) {
    openvdb::initialize();
    EXPECT_FALSE(survivesHalf(fromOpenVdb(openvdb::Int32Grid::create(0))));
    const auto fine = openvdb::DoubleGrid::create(0.5);
    EXPECT_TRUE(survivesHalf(fromOpenVdb(fine)));
    fine->tree().setValueOn(Coord(0), 1.0 + 0x1p-40);
    EXPECT_FALSE(survivesHalf(fromOpenVdb(fine)));
}

}  // namespace
}  // namespace deltasplat
