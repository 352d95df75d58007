// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <limits>

#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "unit/ingest_helpers.h"
#include "unit/vdb_helpers.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::expectSame;
using testing::makeGrid;
using testing::TempFolder;
using testing::writeGrids;

TEST(ReadVdb, FloatsAreSpreadOverTheirRange) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::FloatGrid>(
        "density", [](int i) { return -0.25f + 0.001f * float(i); }, 0.125f);
    writeGrids("a.vdb", {grid});
    const Volume exact = readVolume("a.vdb");
    EXPECT_EQ(exact.codeBook().kind, CodeBook::Kind::kTable);
    expectSame(exact, *grid, 0);

    ReadOptions options;
    options.bits = 16;
    const Volume volume = readVolume("a.vdb", options);
    EXPECT_EQ(volume.name(), "density");
    EXPECT_EQ(volume.type(), "float");
    EXPECT_EQ(volume.gridClass(), "unknown");
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kLinear);
    EXPECT_EQ(volume.valueMin(), -0.25);
    expectSame(volume, *grid, volume.codeBook().step * 0.5000001);
}

// Under gzip or not is what the bytes are, whatever the name says.
TEST(ReadVdb, PackedByContent) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::FloatGrid>(
        "density", [](int i) { return 0.5f * float(i); }, 0.125f);
    writeGrids("a.vdb", {grid});
    const std::string bytes = testing::readBytes("a.vdb");
    testing::writeGzip("b.vdb.gz", bytes);
    testing::writeGzip("c.vdb", bytes);
    testing::writeBytes("d.vdb.gz", bytes);
    for (const char* const name : {"b.vdb.gz", "c.vdb", "d.vdb.gz"}) {
        SCOPED_TRACE(name);
        ReadOptions kept;
        kept.keepSource = true;
        for (const ReadOptions& options : {ReadOptions(), kept}) {
            const Volume volume = readVolume(name, options);
            EXPECT_EQ(volume.name(), "density");
            expectSame(volume, *grid, 0);
        }
        EXPECT_EQ(listVolumes(name).at(0).name, "density");
    }
    const std::string packed = testing::readBytes("b.vdb.gz");
    testing::writeBytes("e.vdb.gz", packed.substr(0, packed.size() / 2));
    testing::expectError(ErrorCode::kInput,
                         "e.vdb.gz: got a gzip stream that is cut short; expected a whole one",
                         [] { readVolume("e.vdb.gz"); });
}

TEST(ReadVdb, HalvesAreExact) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::FloatGrid>(
        "density", [](int i) { return std::ldexp(float(i % 1000) - 500, i % 9 - 20); }, 0);
    grid->setSaveFloatAsHalf(true);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.type(), "half");
    EXPECT_EQ(volume.gridClass(), "fog volume");
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kHalf);
    expectSame(volume, *grid, 0);
}

// Values that happen to be halves need not be stored as such; one more bit breaks it.
TEST(ReadVdb, TheHalfBookNeedsEveryValueToBeAHalf) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::FloatGrid>(
        "density", [](int i) { return float(i % 2048) / 2048; }, 0);
    writeGrids("a.vdb", {grid});
    EXPECT_EQ(readVolume("a.vdb").codeBook().kind, CodeBook::Kind::kHalf);
    EXPECT_EQ(readVolume("a.vdb").type(), "float");
    grid->tree().setValue(Coord(0), 2049.0f / 4096);
    writeGrids("a.vdb", {grid});
    EXPECT_EQ(readVolume("a.vdb").codeBook().kind, CodeBook::Kind::kTable);
    grid->tree().setValue(Coord(0), 0.5f);
    grid->tree().addTile(1, Coord(-160, 8, 16), 65536, true);
    writeGrids("a.vdb", {grid});
    EXPECT_EQ(readVolume("a.vdb").codeBook().kind, CodeBook::Kind::kTable);
}

TEST(ReadVdb, Doubles) {
    const TempFolder folder;
    const auto grid = makeGrid<openvdb::DoubleGrid>(
        "d", [](int i) { return 1e-30 * (1 + std::sin(i)); }, 0);
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.type(), "double");
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kTable);
    expectSame(volume, *grid, 0);

    ReadOptions options;
    options.bits = 9;
    const Volume coarse = readVolume("a.vdb", options);
    EXPECT_NEAR(coarse.codeBook().codeOf(coarse.valueMax()), 509, 2);
    expectSame(coarse, *grid, coarse.codeBook().step * 0.5000001);
}

template <typename Grid>
void expectIntegers(const std::string& type, std::int64_t low, std::int64_t high, bool near) {
    using T = typename Grid::ValueType;
    const auto grid = makeGrid<Grid>(
        "i", [&](int i) { return T(i == 0   ? low
                                   : i == 5 ? high
                                            : low + 7 * i % (high - low)); },
        T(low));
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.type(), type);
    ASSERT_EQ(volume.codeBook().kind, near ? CodeBook::Kind::kInteger : CodeBook::Kind::kTable);
    EXPECT_EQ(volume.valueMin(), double(low));
    expectSame(volume, *grid, 0);
}

TEST(ReadVdb, Integers) {
    const TempFolder folder;
    expectIntegers<openvdb::Int32Grid>("int32", -2147483648LL, -2147418113LL, true);
    expectIntegers<openvdb::Int32Grid>("int32", -5, 65530, true);
    expectIntegers<openvdb::Int32Grid>("int32", -5, 65531, false);
    expectIntegers<openvdb::Int64Grid>("int64", 9007199254675457LL, 9007199254740992LL, true);
    expectIntegers<openvdb::Int64Grid>("int64", -(1LL << 40), 1LL << 40, false);
}

// Beyond 2^53 neighbouring integers are one double: no integer book can hold them apart.
TEST(ReadVdb, HugeIntegers) {
    const TempFolder folder;
    auto grid = openvdb::Int64Grid::create(0);
    grid->tree().setValue(Coord(1, 2, 3), std::numeric_limits<std::int64_t>::max());
    grid->tree().setValue(Coord(1, 2, 4), std::numeric_limits<std::int64_t>::min());
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_FALSE(volume.codeBook().isExact());
    EXPECT_EQ(volume.valueMin(), -0x1p63);
    EXPECT_EQ(volume.valueMax(), 0x1p63);
    EXPECT_EQ(volume.codeError().absolute, 0);
}

TEST(ReadVdb, BoolsAndMasks) {
    const TempFolder folder;
    const auto bools = makeGrid<openvdb::BoolGrid>(
        "b", [](int i) { return i % 3 == 0; }, false);
    writeGrids("b.vdb", {bools});
    const Volume volume = readVolume("b.vdb");
    EXPECT_EQ(volume.type(), "bool");
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kInteger);
    expectSame(volume, *bools, 0);

    auto masks = openvdb::MaskGrid::create();
    masks->tree().setValueOn(Coord(-5, 6, 7));
    masks->tree().setValueOn(Coord(5, 60, 7));
    masks->tree().addTile(1, Coord(64, 0, 0), true, true);
    writeGrids("m.vdb", {masks});
    const Volume mask = readVolume("m.vdb");
    EXPECT_EQ(mask.type(), "mask");
    EXPECT_EQ(mask.activeCount(), 514u);
    EXPECT_EQ(mask.histogram()[1], 514u);
    EXPECT_EQ(mask.valueMin(), 1);
    expectSame(mask, *masks, 0);
}

TEST(ReadVdb, PlacesVoxelsInTheWorld) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::FloatGrid>(
        "g", [](int i) { return float(i); }, 0);
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    matrix.setToRotation(openvdb::Vec3d(1, 2, 3).unit(), 0.7);
    matrix.preScale(openvdb::Vec3d(0.5, 1, 2));
    matrix.postTranslate(openvdb::Vec3d(-4, 5, 6));
    const openvdb::math::Transform::Ptr transforms[] = {
        openvdb::math::Transform::createLinearTransform(matrix),
        openvdb::math::Transform::createLinearTransform(0.25),
        openvdb::math::Transform::Ptr(new openvdb::math::Transform(
            openvdb::math::MapBase::Ptr(new openvdb::math::ScaleTranslateMap(
                openvdb::Vec3d(0.01, 0.02, -0.01), openvdb::Vec3d(1, 2, 3)))))};
    for (const auto& transform : transforms) {
        grid->setTransform(transform);
        writeGrids("a.vdb", {grid});
        const Volume volume = readVolume("a.vdb");
        for (const Coord& c : {Coord(0), Coord(1, 0, 0), Coord(-7, 13, 29)}) {
            const openvdb::Vec3d world = transform->indexToWorld(c);
            const glm::dvec4 mapped = volume.worldFromIndex() * glm::dvec4(c.x(), c.y(), c.z(), 1);
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(mapped[axis], world[axis], 1e-12);
        }
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(volume.voxelSize()[axis], transform->voxelSize()[axis], 1e-12);
        }
    }
}

TEST(ReadVdb, LevelSetsBecomeFog) {
    const TempFolder folder;
    openvdb::initialize();
    auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10, {0, 0, 0}, 0.5f);
    sphere->setName("ls");
    writeGrids("a.vdb", {sphere});
    const Volume fog = readVolume("a.vdb");
    EXPECT_EQ(fog.gridClass(), "fog volume");
    EXPECT_EQ(fog.background(), 0);
    EXPECT_GT(fog.valueMin(), 0);
    EXPECT_EQ(fog.valueMax(), 1);
    // All of the inside is active, none of the outside; deep inside is 1.
    EXPECT_NEAR(double(fog.activeCount()), 4.0 / 3 * M_PI * 20 * 20 * 20, 300);
    Code code = 0;
    EXPECT_TRUE(fog.codes()->tree().probeValue(Coord(0), code));
    EXPECT_NEAR(fog.codeBook().valueOf(code), 1, 1e-9);
    EXPECT_FALSE(fog.codes()->tree().isValueOn(Coord(21, 0, 0)));

    ReadOptions options;
    options.levelSetToFog = false;
    const Volume kept = readVolume("a.vdb", options);
    EXPECT_EQ(kept.gridClass(), "level set");
    EXPECT_EQ(kept.background(), 1.5);
    EXPECT_LT(kept.valueMin(), -1.4);
    expectSame(kept, *sphere, kept.codeBook().step * 0.5000001);
}

// As the distance fields in a Blender cache are.
TEST(ReadVdb, LevelSetsWithoutABandAreKept) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::FloatGrid>(
        "phi", [](int i) { return float(i % 100 - 50); }, 0);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    writeGrids("a.vdb", {grid});
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& line) { warnings.push_back(line); };
    const Volume volume = readVolume("a.vdb", {}, listener);
    EXPECT_EQ(volume.gridClass(), "level set");
    expectSame(volume, *grid, 0);
    EXPECT_EQ(warnings, std::vector<std::string>{"a.vdb: grid \"phi\": level set with background 0 "
                                                 "kept as it is, not made fog"});
}

// Blender marks its integer grids as half floats too; they are integers all the same.
TEST(ReadVdb, IntegersMarkedAsHalf) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::Int32Grid>(
        "flags", [](int i) { return i * 20; }, 0);
    grid->setSaveFloatAsHalf(true);
    writeGrids("a.vdb", {grid});
    const Volume volume = readVolume("a.vdb");
    EXPECT_EQ(volume.type(), "int32");
    expectSame(volume, *grid, 0);
}

TEST(ReadVdb, EmptyGridsAreEmptyVolumes) {
    const TempFolder folder;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(3);
    grid->setName("nothing");
    writeGrids("a.vdb", {grid});
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& line) { warnings.push_back(line); };
    const Volume volume = readVolume("a.vdb", {}, listener);
    EXPECT_TRUE(volume.empty());
    EXPECT_TRUE(volume.box().empty());
    EXPECT_EQ(volume.background(), 3);
    EXPECT_EQ(volume.valueMax(), 0);
    EXPECT_TRUE(volume.codes()->tree().empty());
    EXPECT_EQ(volume.histogram(), std::vector<std::uint64_t>(kCodeCount));
    EXPECT_EQ(warnings, std::vector<std::string>{"a.vdb: grid \"nothing\": no active voxels"});
}

TEST(ReadVdb, ReplacesNonFiniteActiveValues) {
    const TempFolder folder;
    auto grid = makeGrid<openvdb::FloatGrid>(
        "g", [](int i) { return float(i % 500); }, 0);
    auto clean = grid->deepCopy();
    grid->tree().setValue(Coord(3, 4, 5), std::nanf(""));
    clean->tree().setValue(Coord(3, 4, 5), 1000);
    grid->tree().addTile(1, Coord(-320, 0, 0), -std::numeric_limits<float>::infinity(), true);
    clean->tree().addTile(1, Coord(-320, 0, 0), 1000, true);
    // What is inactive is nobody's value.
    grid->tree().setValueOff(Coord(6, 6, 6), std::nanf(""));
    clean->tree().setValueOff(Coord(6, 6, 6), 0);
    writeGrids("a.vdb", {grid});
    ReadOptions options;
    options.nanValue = 1000;
    expectSame(readVolume("a.vdb", options), *clean, 0);
}

TEST(ReadVdb, NonFiniteBackgroundIsZeroWithAWarning) {
    const TempFolder folder;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(std::nanf(""));
    grid->setName("g");
    grid->tree().setValue(Coord(1), 2);
    writeGrids("a.vdb", {grid});
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& line) { warnings.push_back(line); };
    EXPECT_EQ(readVolume("a.vdb", {}, listener).background(), 0);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], "a.vdb: grid \"g\": background nan taken as 0");
}

TEST(ReadVdb, ThreadsDoNotMatter) {
    const TempFolder folder;
    writeGrids("a.vdb", {makeGrid<openvdb::FloatGrid>(
                            "g", [](int i) { return std::sin(float(i)); }, 0)});
    const auto read = [&](int threads) {
        const ThreadLimit limit(threads);
        return readVolume("a.vdb");
    };
    const Volume one = read(1);
    const Volume many = read(4);
    EXPECT_EQ(one.histogram(), many.histogram());
    EXPECT_EQ(one.codeBook().step, many.codeBook().step);
    EXPECT_EQ(one.codeBook().offset, many.codeBook().offset);
}

}  // namespace
}  // namespace deltasplat
