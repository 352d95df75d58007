// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "formats/vdb/vdb_file.h"
#include "unit/ingest_helpers.h"
#include "unit/vdb_compare.h"
#include "unit/vdb_helpers.h"
#include "volume/tree_types.h"

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
    EXPECT_EQ(readVolume("a.vdb").name(), "z");
    EXPECT_EQ(readVolume("a.vdb").valueMax(), 4);
    const std::vector<Volume> all = readAllVolumes("a.vdb");
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].name(), "z");
    EXPECT_EQ(all[1].name(), "b");
    ReadOptions options;
    options.gridName = "b";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 5);
    EXPECT_EQ(readAllVolumes("a.vdb", options).size(), 1u);
}

openvdb::FloatGrid::Ptr withClass(const std::string& name, openvdb::GridClass gridClass) {
    auto grid = oneVoxel(name, 1);
    grid->setGridClass(gridClass);
    return grid;
}

std::string defaultGridOf(const openvdb::GridCPtrVec& grids) {
    writeGrids("a.vdb", grids);
    return readVolume("a.vdb").name();
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

// The surface of a liquid is what its simulation is of.
TEST(ReadVdbGrids, PhiComesBeforeWhatHelpsItsSolver) {
    const TempFolder folder;
    const auto phi = withClass("phi", openvdb::GRID_LEVEL_SET);
    const auto obstacle = withClass("phi_obstacle", openvdb::GRID_LEVEL_SET);
    const auto inflow = withClass("phiIn", openvdb::GRID_LEVEL_SET);
    const auto shadow = withClass("shadow", openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(defaultGridOf({obstacle, inflow, phi}), "phi");
    EXPECT_EQ(defaultGridOf({phi, shadow, obstacle}), "phi");
    EXPECT_EQ(defaultGridOf({obstacle, phi, oneVoxel("speed", 1)}), "speed");
    EXPECT_EQ(defaultGridOf({obstacle, oneVoxel("density", 1), phi}), "density");
}

TEST(ReadVdbGrids, AGridWithoutANameCanBeAskedFor) {
    const TempFolder folder;
    writeGrids("a.vdb", {oneVoxel("density", 1), oneVoxel("", 2)});
    ReadOptions options;
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 1);
    options.gridName = "";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 2);
    EXPECT_EQ(readAllVolumes("a.vdb", options).size(), 1u);
    writeGrids("a.vdb", {oneVoxel("b", 3), oneVoxel("", 4), oneVoxel("", 5)});
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 4);
    options.gridName = "[1]";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 5);
    EXPECT_TRUE(listGrids("a.vdb").preferred == "b");
}

// The file of a grid named density, and of one named heat, after some bytes have become others of
// the same length.
std::string withBytes(const openvdb::GridBase::Ptr& density, const std::string& old,
                      const std::string& changed) {
    writeGrids("a.vdb", {density, oneVoxel("heat", 5)});
    std::string bytes = testing::readBytes("a.vdb");
    const std::size_t at = bytes.find(old);
    EXPECT_NE(at, std::string::npos);
    EXPECT_EQ(old.size(), changed.size());
    bytes.replace(at, old.size(), changed);
    testing::writeBytes("a.vdb", bytes);
    return bytes;
}

// Another grid than the one that is meant would be shown without a word; the others can be read.
void expectDensityInTheWay(const std::string& got, const std::string& expected,
                           const std::string& leftOut) {
    SCOPED_TRACE(got);
    testing::expectError(ErrorCode::kInput, "a.vdb: " + got + "; expected " + expected,
                         [] { readVolume("a.vdb"); });
    ReadOptions options;
    options.gridName = "heat";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 5);
    std::vector<std::string> read;
    std::vector<std::string> others;
    VolumeVisitor visitor;
    visitor.volume = [&](const Volume& volume) { read.push_back(volume.name()); };
    visitor.other = [&](const std::string& name, const std::string& type) {
        others.push_back(name + " (" + type + ")");
    };
    forEachVolume("a.vdb", {}, visitor);
    EXPECT_EQ(read, std::vector<std::string>{"heat"});
    EXPECT_EQ(others, std::vector<std::string>{leftOut});
}

constexpr const char* kScalar = "a scalar grid (float, double, half, int32, int64, bool or mask)";

TEST(ReadVdbGrids, NeverTheNextGridWhereDensityIsOfAnotherKind) {
    const TempFolder folder;
    const auto typeOf = [](const std::string& type) {
        return "got grid \"density\" of type " + type;
    };
    withBytes(oneVoxel("density", 1), "Tree_float_5_4_3", "Tree_uint8_5_4_3");
    expectDensityInTheWay(typeOf("uint8"), kScalar, "density (uint8)");
    EXPECT_EQ(listVolumes("a.vdb")[0].obstacle, "type uint8");
    withBytes(oneVoxel("density", 1), "Tree_float_5_4_3", "Tree_float_6_4_3");
    expectDensityInTheWay(typeOf("Tree_float_6_4_3"), kScalar, "density (Tree_float_6_4_3)");
    withBytes(oneVoxel("density", 1), "Tree_float_5_4_3", "Tree_weird_5_4_3");
    expectDensityInTheWay(typeOf("weird"), kScalar, "density (weird)");
    auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("density");
    writeGrids("a.vdb", {vectors, oneVoxel("heat", 5)});
    expectDensityInTheWay(typeOf("vec3s"),
                          kScalar + std::string(", or a part of it such as density.x"),
                          "density (vec3s)");
}

TEST(ReadVdbGrids, NeverTheNextGridWhereDensityIsStoredInAnotherWay) {
    const TempFolder folder;
    const std::string where = "grid \"density\": got ";
    auto frustum = oneVoxel("density", 1);
    frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 10));
    writeGrids("a.vdb", {frustum, oneVoxel("heat", 5)});
    const std::string lens = "a NonlinearFrustumMap transform";
    expectDensityInTheWay(where + lens, "a linear one (no frustum)",
                          "density (float, " + lens + ")");
    EXPECT_EQ(listVolumes("a.vdb")[0].obstacle, lens);
    withBytes(oneVoxel("density", 1), "UniformScaleMap", "UniformLensMap ");
    expectDensityInTheWay(where + "a UniformLensMap  transform", "one that OpenVDB 10 knows",
                          "density (float, a UniformLensMap  transform)");
    writeGrids("a.vdb", {oneVoxel("density", 1), oneVoxel("heat", 5)});
    std::string bytes = testing::readBytes("a.vdb");
    const std::size_t head = VdbFile("a.vdb").grids()[0].data;
    bytes[head + 1] = 8;
    testing::writeBytes("a.vdb", bytes);
    std::ostringstream got;
    got << "compression flags 0x" << std::hex << (0x800 + int(bytes[head]));
    expectDensityInTheWay(where + got.str(), "none but zip, active mask and Blosc",
                          "density (float, " + got.str() + ")");
}

// What says that it is fog is meant, of whatever type; what says nothing may be anything.
TEST(ReadVdbGrids, NeverTheNextFogVolume) {
    const TempFolder folder;
    const auto heat = withClass("heat", openvdb::GRID_FOG_VOLUME);
    const auto first = [&](openvdb::GridClass gridClass) {
        writeGrids("a.vdb", {withClass("steam", gridClass), heat});
        std::string bytes = testing::readBytes("a.vdb");
        bytes.replace(bytes.find("Tree_float"), 10, "Tree_weird");
        testing::writeBytes("a.vdb", bytes);
    };
    first(openvdb::GRID_FOG_VOLUME);
    testing::expectError(
        ErrorCode::kInput,
        std::string("a.vdb: got grid \"steam\" of type weird; expected ") + kScalar,
        [] { readVolume("a.vdb"); });
    first(openvdb::GRID_UNKNOWN);
    std::vector<std::string> warnings;
    const Listener listener{{}, [&](const std::string& text) { warnings.push_back(text); }};
    EXPECT_EQ(readVolume("a.vdb", {}, listener).name(), "heat");
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "a.vdb: passed over steam (weird), of types that are not known"});
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
    visitor.volume = [&](const Volume& volume) { read.push_back(volume.name()); };
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
    EXPECT_EQ(readVolume("a.vdb").valueMax(), 2);
}

TEST(ReadVdbGrids, InactiveNaNIsNobodysValue) {
    const TempFolder folder;
    auto grid = oneVoxel("density", 3);
    grid->tree().setValueOff(Coord(2, 2, 3), std::nanf(""));
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.activeCount(), 1u);
    EXPECT_EQ(volume.valueMax(), 3);
}

TEST(ReadVdbGrids, NamesThatRepeat) {
    const TempFolder folder;
    writeGrids("a.vdb", {oneVoxel("d", 1), oneVoxel("d", 2), oneVoxel("", 3)});
    const std::vector<Volume> all = readAllVolumes("a.vdb");
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].name(), "d[0]");
    EXPECT_EQ(all[1].name(), "d[1]");
    ReadOptions options;
    options.gridName = "d[1]";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 2);
    options.gridName = "d";
    EXPECT_EQ(readVolume("a.vdb", options).valueMax(), 1);
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
    EXPECT_EQ(volume.valueMax(), 1.5);
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
    EXPECT_EQ(all[0].name(), "f");
    EXPECT_EQ(all[1].type(), "half");
    EXPECT_EQ(all[1].valueMax(), 2.5);
}

// OpenVDB 13 writes version 225 for every file, of which only grids of halves are new.
TEST(ReadVdbGrids, FilesOfOpenVdb13) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::FloatGrid>(
        "g", [](int i) { return float(i % 1000); }, 0);
    writeGrids("a.vdb", {grid});
    std::string bytes = testing::readBytes("a.vdb");
    bytes[8] = char(225);
    testing::writeBytes("a.vdb", bytes);
    expectSame(readVolume("a.vdb"), *grid, 0);
}

using HalfTree = openvdb::tree::Tree4<openvdb::math::half, 5, 4, 3>::Type;
using HalfGrid = openvdb::Grid<HalfTree>;

// The same values in halves.
HalfGrid::Ptr inHalves(const openvdb::FloatGrid& grid) {
    auto halves = HalfGrid::create(openvdb::math::half(grid.background()));
    halves->setName(grid.getName());
    for (auto value = grid.cbeginValueAll(); value; ++value) {
        const openvdb::math::half half(*value);
        if (value.isVoxelValue()) {
            halves->tree().setValueOnly(value.getCoord(), half);
            halves->tree().setActiveState(value.getCoord(), value.isValueOn());
        } else {
            halves->tree().addTile(value.getLevel(), value.getCoord(), half, value.isValueOn());
        }
    }
    return halves;
}

TEST(ReadVdbGrids, GridsOfHalves) {
    const TempFolder folder;
    constexpr std::uint32_t kMask = openvdb::io::COMPRESS_ACTIVE_MASK;
    for (const float background : {0.0F, 2.5F}) {
        const auto grid = makeGrid<openvdb::FloatGrid>(
            "g", [](int i) { return float(i % 1000) / 8 - 50; }, background);
        grid->tree().addTile(3, Coord(8192, 0, 0), 0.5F, true);
        // One, two and more different values that are not active, of leaf after leaf.
        grid->tree().setValueOff(Coord(300, 0, 0), -background);
        grid->tree().setValueOff(Coord(320, 0, 0), 7);
        grid->tree().setValueOff(Coord(320, 0, 1), -7);
        for (int i = 0; i < 5; ++i) grid->tree().setValueOff(Coord(340, 0, i), float(i));
        grid->tree().addTile(1, Coord(352, 0, 0), -background, false);
        const auto halves = inHalves(*grid);
        for (const std::uint32_t method :
             {std::uint32_t(openvdb::io::COMPRESS_NONE), std::uint32_t(openvdb::io::COMPRESS_ZIP),
              std::uint32_t(openvdb::io::COMPRESS_BLOSC)}) {
            for (const std::uint32_t flags : {method, method | kMask}) {
                for (const bool asHalf : {false, true}) {
                    SCOPED_TRACE(std::to_string(flags) + (asHalf ? " saved as half" : ""));
                    halves->setSaveFloatAsHalf(asHalf);
                    openvdb::io::File file("a.vdb");
                    file.setCompression(flags);
                    file.write(openvdb::GridCPtrVec{halves});
                    const Volume volume = readVolume("a.vdb");
                    EXPECT_EQ(volume.type(), "half");
                    expectSame(volume, *grid, 0);
                    const VdbFile vdb("a.vdb");
                    const TreeGrid read = vdb.read(vdb.grids()[0], {});
                    ASSERT_TRUE(read.as<openvdb::FloatTree>());
                    EXPECT_EQ(testing::countDifferences(*read.as<openvdb::FloatTree>(),
                                                        grid->constTree()),
                              0u);
                }
            }
        }
    }
}

// Each names a parent, and none of many is to be looked for among all of them; lines about them
// stay lines.
TEST(ReadVdbGrids, ManyGrids) {
    const TempFolder folder;
    constexpr std::size_t kCount = 60000;
    writeGrids("a.vdb", {oneVoxel("x", 1)});
    const std::string whole = testing::readBytes("a.vdb");
    const VdbGrid one = VdbFile("a.vdb").grids()[0];
    // Of what each has of its own: compression, metadata and a transform.
    const std::size_t map = whole.find("UniformScaleMap");
    const std::string head = whole.substr(one.data, map + 15 + 15 * 8 - one.data);
    std::string bytes = whole.substr(0, whole.find("Tree_float") - 4 - 4 - 1 - 4);
    const auto append = [&](auto number) {
        bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    const auto appendText = [&](const std::string& text) {
        append(std::uint32_t(text.size()));
        bytes += text;
    };
    append(std::int32_t(kCount));
    for (std::size_t i = 0; i < kCount; ++i) {
        appendText("grid" + std::to_string(i));
        appendText("Tree_float_5_4_3");
        appendText("nobody");
        const std::size_t begin = bytes.size() + 24;
        append(std::int64_t(begin));
        append(std::int64_t(begin + head.size()));
        append(std::int64_t(begin + head.size()));
        bytes += head;
    }
    testing::writeBytes("many.vdb", bytes);
    EXPECT_EQ(VdbFile("many.vdb").grids().size(), kCount);
    ReadOptions options;
    options.gridName = "none";
    try {
        readVolume("many.vdb", options);
        FAIL();
    } catch (const Error& error) {
        const std::string line = error.what();
        EXPECT_LT(line.size(), 2000u);
        EXPECT_NE(line.find("grid31 (float) and 59968 others"), line.npos) << line;
    }
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
