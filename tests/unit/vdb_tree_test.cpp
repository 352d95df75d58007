// SPDX-License-Identifier: Apache-2.0
// Grids that VdbFile::read() reads here have to be those that OpenVDB reads, inactive values,
// tiles, metadata and transforms included: both are written again, and compared byte by byte.
#include "formats/vdb/vdb_tree.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>
#include <openvdb/io/Compression.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "formats/vdb/vdb_file.h"
#include "formats/vdb/write_vdb.h"
#include "unit/convert_helpers.h"
#include "unit/random_grid.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::Inactive;
using testing::randomGrid;
using testing::TempFolder;

// OpenVDB's compressions, alone and together.
constexpr std::uint32_t kCompressions[] = {
    openvdb::io::COMPRESS_NONE,  openvdb::io::COMPRESS_ACTIVE_MASK,
    openvdb::io::COMPRESS_ZIP,   openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
    openvdb::io::COMPRESS_BLOSC, openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK,
};

void writeBy(const std::string& file, const openvdb::GridBase::Ptr& grid,
             std::uint32_t compression) {
    openvdb::io::File out(file);
    out.setCompression(compression);
    out.write(openvdb::GridPtrVec{grid});
    out.close();
}

TreeGrid readHere(const std::string& file) {
    const VdbFile vdb(file);
    return vdb.read(vdb.grids().front(), {});
}

void expectSameRead(const openvdb::GridBase::Ptr& grid) {
    const TempFolder folder;
    for (const std::uint32_t compression : kCompressions) {
        SCOPED_TRACE(compression);
        writeBy("a.vdb", grid, compression);
        WrittenGrid theirs = writtenGrid(fromOpenVdb(testing::readGrids("a.vdb").front()));
        // What the type of the grid says as well, which counts.
        if (!theirs.isHalf()) theirs.metadata.erase(openvdb::GridBase::META_SAVE_HALF_FLOAT);
        writeVdb("theirs.vdb", {theirs});
        const TreeGrid ours = readHere("a.vdb");
        writeVdb("ours.vdb", {writtenGrid(ours)});
        EXPECT_TRUE(testing::readBytes("theirs.vdb") == testing::readBytes("ours.vdb"));
        EXPECT_EQ(ours.tree->type(), grid->type());
    }
}

// Whether two trees have the same values, bit for bit, in nodes of the same places.
template <typename Tree>
bool areSame(const Tree& a, const Tree& b) {
    const auto bytesOf = [](const auto& value) {
        return std::string_view(reinterpret_cast<const char*>(&value), sizeof value);
    };
    auto voxel = a.cbeginValueAll();
    auto other = b.cbeginValueAll();
    for (; voxel && other; ++voxel, ++other) {
        const auto mine = *voxel;
        const auto theirs = *other;
        if (voxel.getBoundingBox() != other.getBoundingBox() ||
            voxel.isValueOn() != other.isValueOn() || bytesOf(mine) != bytesOf(theirs))
            return false;
    }
    return !voxel && !other && a.background() == b.background();
}

template <typename Grid>
void expectSameTrees(const typename Grid::Ptr& grid) {
    using Tree = typename Grid::TreeType;
    const TempFolder folder;
    for (const std::uint32_t compression : kCompressions) {
        SCOPED_TRACE(grid->type() + " compression " + std::to_string(compression));
        writeBy("a.vdb", grid, compression);
        const auto theirs = openvdb::gridPtrCast<Grid>(testing::readGrids("a.vdb").front());
        const TreeGrid ours = readHere("a.vdb");
        ASSERT_TRUE(ours.as<Tree>());
        EXPECT_TRUE(areSame(*ours.as<Tree>(), theirs->tree()));
        EXPECT_EQ(ours.name(), grid->getName());
    }
}

template <typename Grid>
void expectSameVectors() {
    unsigned seed = 1;
    for (const Inactive inactive : testing::kAllInactive) {
        for (const bool half : {false, true}) {
            const auto grid = randomGrid<Grid>(100, inactive, 3, ++seed);
            grid->setSaveFloatAsHalf(half);
            SCOPED_TRACE("half " + std::to_string(half) + " kind " + std::to_string(int(inactive)));
            expectSameTrees<Grid>(grid);
        }
    }
}

template <typename Grid>
void expectSameReadOfAll() {
    unsigned seed = 1;
    for (const int background : {0, 3}) {
        for (const Inactive inactive : testing::kAllInactive) {
            for (const bool half : {false, true}) {
                const auto grid = randomGrid<Grid>(300, inactive, background, ++seed);
                grid->setSaveFloatAsHalf(half);
                SCOPED_TRACE(grid->type() + " half " + std::to_string(half) + " kind " +
                             std::to_string(int(inactive)));
                expectSameRead(grid);
            }
        }
    }
}

TEST(VdbTree, NumbersAreReadAsByOpenVdb) {
    expectSameReadOfAll<openvdb::FloatGrid>();
    expectSameReadOfAll<openvdb::DoubleGrid>();
    expectSameReadOfAll<openvdb::Int32Grid>();
    expectSameReadOfAll<openvdb::Int64Grid>();
}

TEST(VdbTree, BoolsAndMasksAreReadAsByOpenVdb) {
    expectSameReadOfAll<openvdb::BoolGrid>();
    expectSameReadOfAll<openvdb::MaskGrid>();
}

TEST(VdbTree, VectorsAreReadAsByOpenVdb) {
    expectSameVectors<openvdb::Vec3SGrid>();
    expectSameVectors<openvdb::Vec3DGrid>();
    expectSameVectors<openvdb::Vec3IGrid>();
}

// Says of the last grid of a file that its values are whole floats.
// @param type  place of its type in the file, and how long that is without "_HalfFloat"
std::string withoutHalf(std::string bytes, std::size_t type, std::size_t length) {
    const std::string half = "_HalfFloat";
    bytes.erase(type + length, half.size());
    const auto subtract = [&](std::size_t place, auto number) {
        std::memcpy(&number, &bytes[place], sizeof number);
        number -= decltype(number)(half.size());
        std::memcpy(&bytes[place], &number, sizeof number);
    };
    subtract(type - 4, std::uint32_t{});
    std::uint32_t parent = 0;
    std::memcpy(&parent, &bytes[type + length], sizeof parent);
    for (std::size_t i = 0; i < 3; ++i)
        subtract(type + length + 4 + parent + 8 * i, std::uint64_t{});
    return bytes;
}

// Voxels that several grids have are stored once, of the first, and read of each.
TEST(VdbTree, GridsThatShareVoxelsAreReadAsByOpenVdb) {
    const TempFolder folder;
    const auto first = randomGrid<openvdb::FloatGrid>(20, Inactive::kTwo, 1, 7);
    first->setSaveFloatAsHalf(true);
    const auto second = openvdb::FloatGrid::create(first->treePtr());
    second->setName("second");
    second->setSaveFloatAsHalf(true);
    second->insertMeta("note", openvdb::StringMetadata("its own"));
    second->setTransform(openvdb::math::Transform::createLinearTransform(3));
    openvdb::io::File("a.vdb").write(openvdb::GridCPtrVec{first, second});
    const VdbFile file("a.vdb");
    const VdbGrid& shared = file.grids().back();
    ASSERT_EQ(shared.parentName, "grid");
    const TreeGrid ours = file.read(shared, {});
    const TreeGrid whole = file.read(file.grids().front(), {});
    EXPECT_TRUE(areSame(*ours.as<openvdb::FloatTree>(), *whole.as<openvdb::FloatTree>()));
    EXPECT_EQ(ours.metadata.text("note"), "its own");
    EXPECT_EQ(ours.map->voxelSize(), openvdb::Vec3d(3));
    EXPECT_TRUE(file.readValues(shared, VdbFile::Find::kByNotes));
    EXPECT_TRUE(file.readPacked(shared));

    std::string bytes = testing::readBytes("a.vdb");
    const std::string type = "Tree_float_5_4_3";
    testing::writeBytes("whole.vdb", withoutHalf(bytes, bytes.rfind(type), type.size()));
    const VdbFile other("whole.vdb");
    EXPECT_EQ(other.grids().back().valueType(), "half");
    EXPECT_TRUE(areSame(*other.read(other.grids().back(), {}).as<openvdb::FloatTree>(),
                        *whole.as<openvdb::FloatTree>()));

    bytes.replace(bytes.rfind(type), type.size(), "Tree_int32_5_4_3");
    testing::writeBytes("b.vdb", bytes);
    const VdbFile damaged("b.vdb");
    testing::expectError(ErrorCode::kInput,
                         "b.vdb: got a grid of type int32 that shares voxels of type float; "
                         "expected a sound .vdb file",
                         [&] { damaged.read(damaged.grids().back(), {}); });
}

TEST(VdbTree, OddGridsAreReadAsByOpenVdb) {
    openvdb::initialize();
    const auto odd = openvdb::FloatGrid::create(0.1F);
    expectSameRead(odd);
    odd->tree().setValueOn(Coord(0, 0, 0), std::numeric_limits<float>::quiet_NaN());
    odd->tree().setValueOff(Coord(0, 0, 2), std::numeric_limits<float>::infinity());
    odd->tree().setValueOff(Coord(0, 9, 2), -0.0F);
    // A leaf and nodes without any active voxel.
    odd->tree().setValueOff(Coord(0, 0, 20), 0.1F);
    odd->tree().touchLeaf(Coord(-5000, 0, 0));
    odd->tree().root().touchLeaf(Coord(50000, 0, 0))->setValuesOff();
    odd->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 2));
    odd->insertMeta("note", openvdb::StringMetadata("kept"));
    expectSameRead(odd);
    // OpenVDB turns the sign of the background, which of the smallest number is undefined.
    constexpr std::int32_t kBackground = std::numeric_limits<std::int32_t>::min() + 1;
    const auto whole = openvdb::Int32Grid::create(kBackground);
    whole->tree().setValueOff(Coord(0, 0, 0), 5);
    whole->tree().setValueOff(Coord(0, 0, 1), -kBackground);
    expectSameRead(whole);
}

TEST(VdbTree, TheSameOnAnyNumberOfThreads) {
    const TempFolder folder;
    writeBy("a.vdb", randomGrid<openvdb::FloatGrid>(3000, Inactive::kTwo, 1, 7),
            openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        writeVdb(std::to_string(threads) + ".vdb", {writtenGrid(readHere("a.vdb"))});
    }
    EXPECT_TRUE(testing::readBytes("1.vdb") == testing::readBytes("3.vdb"));
}

TEST(VdbTree, WrongNotesOfLeavesDoNoHarm) {
    const TempFolder folder;
    const auto grid = randomGrid<openvdb::FloatGrid>(5, Inactive::kBackground, 0, 7);
    writeBy("a.vdb", grid, openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    std::string bytes = testing::readBytes("a.vdb");
    // Of five leaves sizes are noted as they are, of eight bytes each: the first two change places.
    const std::string name = "__delayedload";
    const std::size_t sizes = bytes.find(name) + name.size() + 4 + 4 + 4 + 5 + 4;
    const std::string first = bytes.substr(sizes, 8);
    const std::string second = bytes.substr(sizes + 8, 8);
    ASSERT_NE(first, second);
    bytes.replace(sizes, 16, second + first);
    testing::writeBytes("b.vdb", bytes);
    writeVdb("sound.vdb", {writtenGrid(readHere("a.vdb"))});
    writeVdb("noted.vdb", {writtenGrid(readHere("b.vdb"))});
    EXPECT_TRUE(testing::readBytes("sound.vdb") == testing::readBytes("noted.vdb"));
}

TEST(VdbTree, LeavesWithoutActiveVoxelsAreSound) {
    const TempFolder folder;
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0);
    grid->tree().setValueOn(Coord(0, 0, 0), 0.1F);
    grid->tree().setValueOff(Coord(0, 0, 20), 0.7F);
    grid->tree().touchLeaf(Coord(100, 0, 0));
    writeBy("a.vdb", grid, openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    EXPECT_EQ(readVolume("a.vdb").activeCount(), 1u);
}

TEST(VdbTree, DamagedLeavesAreRefused) {
    const TempFolder folder;
    writeBy("a.vdb", randomGrid<openvdb::FloatGrid>(50, Inactive::kBackground, 0, 7),
            openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    std::string bytes = testing::readBytes("a.vdb");
    // In the middle of the last leaf's chunk.
    for (std::size_t i = 1; i <= 60; ++i) bytes[bytes.size() - i] = '\xff';
    testing::writeBytes("a.vdb", bytes);
    testing::expectError(
        ErrorCode::kInput,
        "a.vdb: grid \"grid\": got leaves that are damaged; expected a sound OpenVDB grid",
        [] { readHere("a.vdb"); });
}

}  // namespace
}  // namespace deltasplat
