// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>

#include <cmath>
#include <fstream>

#include "deltasplat/ingest/read_volume.h"
#include "ingest/grids/tree_types.h"
#include "unit/ingest_helpers.h"
#include "unit/vdb_helpers.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::expectSame;
using testing::makeGrid;
using testing::oneVoxel;
using testing::TempFolder;
using testing::writeGrids;

TEST(ReadVdbGrids, TakesTheFirstScalarGridOfTheFile) {
    const TempFolder folder;
    auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("a");
    velocity->tree().setValue(Coord(0), openvdb::Vec3s(1, 2, 3));
    writeGrids("a.vdb", {velocity, oneVoxel("z", 4), oneVoxel("b", 5)});
    EXPECT_EQ(readVolume("a.vdb").name, "z");
    EXPECT_EQ(readVolume("a.vdb").valueMax, 4);
    const std::vector<Volume> all = readAllVolumes("a.vdb");
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].name, "z");
    EXPECT_EQ(all[1].name, "b");
    ReadOptions options;
    options.gridName = "b";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax, 5);
    EXPECT_EQ(readAllVolumes("a.vdb", options).size(), 1u);
}

openvdb::FloatGrid::Ptr withClass(const std::string& name, openvdb::GridClass gridClass) {
    auto grid = oneVoxel(name, 1);
    grid->setGridClass(gridClass);
    return grid;
}

std::string defaultGridOf(const openvdb::GridCPtrVec& grids) {
    writeGrids("a.vdb", grids);
    return readVolume("a.vdb").name;
}

TEST(ReadVdbGrids, TheDefaultIsDensityThenFogThenWhatHelpsNoSolver) {
    const TempFolder folder;
    const auto phi = withClass("phi_obstacle", openvdb::GRID_LEVEL_SET);
    const auto flags = oneVoxel("flags", 1);
    const auto shadow = withClass("shadow", openvdb::GRID_FOG_VOLUME);
    const auto noise = withClass("density_noise", openvdb::GRID_FOG_VOLUME);
    const auto speed = oneVoxel("speed", 1);
    const auto surface = withClass("surface", openvdb::GRID_LEVEL_SET);
    const auto heat = withClass("heat", openvdb::GRID_FOG_VOLUME);
    const auto density = oneVoxel("density", 1);
    EXPECT_EQ(defaultGridOf({phi, flags, shadow, noise, speed, heat, density}), "density");
    EXPECT_EQ(defaultGridOf({phi, flags, shadow, noise, speed, heat}), "heat");
    EXPECT_EQ(defaultGridOf({phi, flags, shadow, noise, speed, surface}), "speed");
    EXPECT_EQ(defaultGridOf({phi, flags, shadow, noise, surface}), "surface");
    EXPECT_EQ(defaultGridOf({phi, flags, shadow, noise}), "shadow");
    EXPECT_EQ(defaultGridOf({flags, phi}), "flags");
    EXPECT_EQ(defaultGridOf({heat, oneVoxel("density", 2), density}), "density[0]");
}

TEST(ReadVdbGrids, AGridNamedDensityHasToBeScalar) {
    const TempFolder folder;
    auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("density");
    EXPECT_EQ(defaultGridOf({vectors, oneVoxel("phi", 1), oneVoxel("b", 5)}), "b");
}

// One grid's undefined values are no reason to refuse another one.
TEST(ReadVdbGrids, LevelSetsWithNaNAreAmongTheOthers) {
    const TempFolder folder;
    auto broken = withClass("phi", openvdb::GRID_LEVEL_SET);
    broken->tree().setValue(Coord(4, 5, 6), std::nanf(""));
    writeGrids("a.vdb", {broken, oneVoxel("density", 2)});
    std::vector<std::string> read;
    std::vector<std::string> others;
    VolumeVisitor visitor;
    visitor.volume = [&](const Volume& volume) { read.push_back(volume.name); };
    visitor.other = [&](const std::string& name, const std::string&) { others.push_back(name); };
    forEachVolume("a.vdb", {}, visitor);
    EXPECT_EQ(read, std::vector<std::string>{"density"});
    EXPECT_EQ(others, std::vector<std::string>{"phi"});

    // Asked for, alone, or of another class, it is an error.
    ReadOptions options;
    options.gridName = "phi";
    EXPECT_THROW(forEachVolume("a.vdb", options, visitor), Error);
    writeGrids("a.vdb", {broken});
    EXPECT_THROW(forEachVolume("a.vdb", {}, visitor), Error);
    writeGrids("a.vdb", {broken, broken->deepCopy()});
    EXPECT_THROW(forEachVolume("a.vdb", {}, visitor), Error);
    broken->setGridClass(openvdb::GRID_FOG_VOLUME);
    writeGrids("a.vdb", {broken, oneVoxel("density", 2)});
    EXPECT_THROW(forEachVolume("a.vdb", {}, visitor), Error);
    EXPECT_EQ(readVolume("a.vdb").valueMax, 2);
}

TEST(ReadVdbGrids, InactiveNaNIsNobodysValue) {
    const TempFolder folder;
    auto grid = oneVoxel("density", 3);
    grid->tree().setValueOff(Coord(2, 2, 3), std::nanf(""));
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.activeCount, 1u);
    EXPECT_EQ(volume.valueMax, 3);
}

TEST(ReadVdbGrids, NamesThatRepeat) {
    const TempFolder folder;
    writeGrids("a.vdb", {oneVoxel("d", 1), oneVoxel("d", 2), oneVoxel("", 3)});
    const std::vector<Volume> all = readAllVolumes("a.vdb");
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].name, "d[0]");
    EXPECT_EQ(all[1].name, "d[1]");
    ReadOptions options;
    options.gridName = "d[1]";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax, 2);
    options.gridName = "d";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax, 1);
}

// Grids that share one tree are stored once; each must still be readable alone.
TEST(ReadVdbGrids, InstancesOfOneTree) {
    const TempFolder folder;
    auto first = oneVoxel("first", 1.5f);
    auto second = openvdb::FloatGrid::create(first->treePtr());
    second->setName("second");
    second->setTransform(openvdb::math::Transform::createLinearTransform(3));
    writeGrids("a.vdb", {first, oneVoxel("between", 7), second});
    ReadOptions options;
    options.gridName = "second";
    const Volume volume = readVolume("a.vdb", options);
    EXPECT_EQ(volume.valueMax, 1.5);
    EXPECT_EQ(volume.voxelSize(), glm::dvec3(3));
}

// A stream has no offsets, so that everything must be read at once.
TEST(ReadVdbGrids, FilesWrittenAsAStream) {
    const TempFolder folder;
    auto half = oneVoxel("h", 2.5f);
    half->setSaveFloatAsHalf(true);
    {
        std::ofstream out("a.vdb", std::ios::binary);
        openvdb::io::Stream(out).write({openvdb::GridCPtrVec{oneVoxel("f", 1), half}});
    }
    const std::vector<Volume> all = readAllVolumes("a.vdb");
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].name, "f");
    EXPECT_EQ(all[1].type, "half");
    EXPECT_EQ(all[1].valueMax, 2.5);
}

TEST(ReadVdbGrids, EveryCompression) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::FloatGrid>(
        "g", [](int i) { return float(i % 1000); }, 0);
    constexpr std::uint32_t kMask = openvdb::io::COMPRESS_ACTIVE_MASK;
    for (const std::uint32_t method :
         {std::uint32_t(openvdb::io::COMPRESS_NONE), std::uint32_t(openvdb::io::COMPRESS_ZIP),
          std::uint32_t(openvdb::io::COMPRESS_BLOSC)}) {
        for (const std::uint32_t flags : {method, method | kMask}) {
            openvdb::io::File file("a.vdb");
            file.setCompression(flags);
            file.write(openvdb::GridCPtrVec{grid});
            expectSame(readVolume("a.vdb"), *grid, 0);
        }
    }
}

}  // namespace
}  // namespace deltasplat
