// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "volume/code_tree.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {

inline void writeGrids(const std::string& file, const openvdb::GridCPtrVec& grids) {
    openvdb::io::File(file).write(grids);
}

// Active voxels on both sides of 0, scattered over several nodes, and two active tiles.
template <typename Grid>
typename Grid::Ptr makeGrid(const std::string& name,
                            const std::function<typename Grid::ValueType(int)>& value,
                            typename Grid::ValueType background) {
    openvdb::initialize();
    auto grid = Grid::create(background);
    grid->setName(name);
    std::mt19937 random(17);
    std::uniform_int_distribution<int> place(-150, 150);
    for (int i = 0; i < 3000; ++i) {
        grid->tree().setValue(openvdb::Coord(place(random), place(random), place(random)),
                              value(i));
    }
    grid->tree().addTile(1, openvdb::Coord(-160, 8, 16), value(1), true);
    grid->tree().addTile(2, openvdb::Coord(256, -128, 0), value(2), true);
    return grid;
}

// Compares codes with the grid in every active voxel, both ways, and the statistics.
template <typename Grid>
void expectSame(const Volume& volume, const Grid& grid, double tolerance) {
    const auto& tree = volume.codes()->tree();
    std::map<int, std::uint64_t> counts;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        low = std::min(low, double(*it));
        high = std::max(high, double(*it));
        Code code = 0;
        ASSERT_TRUE(tree.probeValue(it.getCoord(), code));
        ASSERT_NEAR(volume.codeBook().valueOf(code), double(*it), tolerance);
        counts[code] += it.getVoxelCount();
    }
    EXPECT_TRUE(tree.hasSameTopology(grid.tree()));
    EXPECT_EQ(volume.activeCount(), grid.activeVoxelCount());
    EXPECT_EQ(tree.activeVoxelCount(), grid.activeVoxelCount());
    EXPECT_EQ(tree.activeTileCount(), grid.tree().activeTileCount());
    EXPECT_EQ(volume.background(), double(grid.background()));
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(volume.box().min[axis], box.min()[axis]);
        EXPECT_EQ(volume.box().max[axis], box.max()[axis]);
    }
    ASSERT_EQ(volume.histogram().size(), std::size_t(kCodeCount));
    for (int code = 0; code < kCodeCount; ++code) {
        const auto found = counts.find(code);
        ASSERT_EQ(volume.histogram()[std::size_t(code)], found == counts.end() ? 0 : found->second);
    }
    EXPECT_EQ(volume.valueMin(), low);
    EXPECT_EQ(volume.valueMax(), high);
}

inline openvdb::FloatGrid::Ptr oneVoxel(const std::string& name, float value) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create();
    grid->setName(name);
    grid->tree().setValue(openvdb::Coord(1, 2, 3), value);
    return grid;
}

}  // namespace deltasplat::testing
