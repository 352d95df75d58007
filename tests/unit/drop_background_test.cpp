// SPDX-License-Identifier: Apache-2.0
// Sparse grids from dense volumes: which voxels stay active, and that no value changes.
#include <gtest/gtest.h>

#include <glm/common.hpp>

#include "deltasplat/convert/write_volume.h"
#include "unit/convert_helpers.h"
#include "unit/vdb_helpers.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {
namespace {

using openvdb::Coord;
constexpr glm::ivec3 kDims(30, 20, 12);

// Mostly `nothing`, with a block of other values in the middle.
template <typename T>
std::vector<T> island(T nothing) {
    std::vector<T> values;
    for (int z = 0; z < kDims.z; ++z) {
        for (int y = 0; y < kDims.y; ++y) {
            for (int x = 0; x < kDims.x; ++x) {
                const bool land = x > 3 && x < 9 && y > 5 && y < 12 && z > 2 && z < 9;
                values.push_back(land ? T(nothing + T(1) + T((x + y + z) % 5)) : nothing);
            }
        }
    }
    return values;
}

template <typename Grid, typename T>
void expectSparse(const std::vector<T>& values, T nothing) {
    const auto grid = readGrid<Grid>("out.vdb");
    ASSERT_TRUE(grid);
    EXPECT_EQ(double(grid->background()), double(nothing));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Coord place(int(i % 30), int(i / 30 % 20), int(i / 600));
        ASSERT_EQ(double(grid->tree().getValue(place)), double(values[i])) << place;
        ASSERT_EQ(grid->tree().isValueOn(place), values[i] != nothing) << place;
    }
    // Beyond the volume, in the leaves that hold its end as well.
    EXPECT_EQ(double(grid->tree().getValue(Coord(31, 0, 0))), double(nothing));
    EXPECT_LT(grid->tree().leafCount(), 10u);
}

template <typename Grid, typename T>
void expectDropped(const std::string& type, T nothing, const WriteOptions& options) {
    const TempFolder folder;
    const std::vector<T> values = island<T>(nothing);
    const WriteReport report = write("out.vdb", rawVolume(values, kDims, type), options);
    EXPECT_TRUE(report.lossless);
    expectSparse<Grid>(values, nothing);
    // The whole volume comes back, the margin included.
    write("back.raw", readKept("out.vdb"));
    EXPECT_EQ(readBytes("back.raw"), bytesOf(values));
}

TEST(DropBackground, TheMostFrequentValue) {
    WriteOptions options;
    options.dropBackground = true;
    expectDropped<openvdb::FloatGrid, std::uint8_t>("uint8", 0, options);
    expectDropped<openvdb::FloatGrid, std::int16_t>("int16", -1000, options);
    expectDropped<openvdb::FloatGrid, float>("float32", 0.1F, options);
    expectDropped<openvdb::Int32Grid, std::int32_t>("int32", 16777217, options);
}

TEST(DropBackground, AGivenValue) {
    WriteOptions options;
    options.dropBackground = true;
    options.background = 7;
    expectDropped<openvdb::FloatGrid, std::uint8_t>("uint8", 7, options);
}

TEST(DropBackground, AmongMoreValuesThanCodes) {
    const TempFolder folder;
    const glm::ivec3 dims(80, 50, 40);
    std::vector<float> values(std::size_t(dims.x * dims.y * dims.z), 0.3F);
    for (std::size_t i = 0; i < 70000; ++i) values[i] = 1 + float(i) / 70000;
    WriteOptions options;
    options.dropBackground = true;
    write("out.vdb", rawVolume(values, dims, "float32"), options);
    const auto grid = readGrid<openvdb::FloatGrid>("out.vdb");
    EXPECT_EQ(grid->background(), 0.3F);
    EXPECT_EQ(grid->activeVoxelCount(), 70000u);
}

TEST(DropBackground, NothingStandsOut) {
    const TempFolder folder;
    std::vector<std::uint8_t> values(kDims.x * kDims.y * kDims.z);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(i * 7 % 256);
    WriteOptions options;
    options.dropBackground = true;
    const WriteReport report = write("out.vdb", rawVolume(values, kDims, "uint8"), options);
    EXPECT_EQ(report.notes[0],
              "out.vdb: `dropBackground`: no value is frequent enough to be one; every voxel stays "
              "active");
    EXPECT_EQ(readGrid<openvdb::FloatGrid>("out.vdb")->activeVoxelCount(), values.size());
}

TEST(DropBackground, AGridThatHasOne) {
    const TempFolder folder;
    const auto grid = oneVoxel("a", 5);
    grid->tree().setValueOn(Coord(1, 2, 4), 0);
    grid->tree().setValueOff(Coord(1, 2, 5), 9);
    grid->tree().addTile(1, Coord(64, 0, 0), 0, true);
    grid->tree().addTile(1, Coord(128, 0, 0), 6, true);
    writeGrids("in.vdb", {grid});
    WriteOptions options;
    options.dropBackground = true;
    const WriteReport report = write("out.vdb", readKept("in.vdb"), options);
    EXPECT_EQ(report.notes, std::vector<std::string>{
                                "out.vdb: grid \"a\": 513 active voxels of value 0 made inactive"});
    EXPECT_FALSE(report.lossless);
    const auto back = readGrid<openvdb::FloatGrid>("out.vdb");
    EXPECT_EQ(back->activeVoxelCount(), 513u);
    EXPECT_TRUE(back->tree().isValueOn(Coord(1, 2, 3)));
    EXPECT_EQ(back->tree().getValue(Coord(1, 2, 5)), 9);
    EXPECT_EQ(back->tree().getValue(Coord(130, 0, 0)), 6);

    options.background = 5;
    const WriteReport other = write("out.vdb", readKept("in.vdb"), options);
    EXPECT_EQ(other.notes, std::vector<std::string>{"out.vdb: `background`: has no effect on grid "
                                                    "\"a\", whose background is 0"});
    EXPECT_EQ(readGrid<openvdb::FloatGrid>("out.vdb")->activeVoxelCount(),
              grid->activeVoxelCount());
}

TEST(DropBackground, AValueThatTheTypeCannotHold) {
    const TempFolder folder;
    WriteOptions options;
    options.dropBackground = true;
    options.background = 1e300;
    expectError(ErrorCode::kUsage, "`background`: got 1e+300; expected a value of type float", [&] {
        write("out.vdb", rawVolume(island<std::uint8_t>(0), kDims, "uint8"), options);
    });
    options.background = 0.5;
    expectError(ErrorCode::kUsage, "`background`: got 0.5; expected a value of type int32", [&] {
        write("out.vdb", rawVolume(island<std::int32_t>(16777217), kDims, "int32"), options);
    });
}

}  // namespace
}  // namespace deltasplat::testing
