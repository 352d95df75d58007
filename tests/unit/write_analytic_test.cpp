// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/write_analytic.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "unit/file_limits.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

// No two lengths alike, and none a multiple of a leaf's 8.
constexpr glm::ivec3 kDims(21, 13, 10);

AnalyticFileOptions options(glm::ivec3 dims, std::string type = "") {
    AnalyticFileOptions result;
    result.dims = dims;
    result.type = std::move(type);
    return result;
}

glm::dvec3 placeOf(int i, int j, int k) {
    return {(2.0 * i + 1) / kDims.x - 1, (2.0 * j + 1) / kDims.y - 1, (2.0 * k + 1) / kDims.z - 1};
}

double expectedAt(const AnalyticVolume& volume, int i, int j, int k) {
    return volume.valueAt(placeOf(i, j, k));
}

// Calls visit(expected value) in the order of a raw file: x fastest, then y, then z.
template <typename Visit>
void forVoxels(const AnalyticVolume& volume, Visit visit) {
    for (int k = 0; k < kDims.z; ++k) {
        for (int j = 0; j < kDims.y; ++j) {
            for (int i = 0; i < kDims.x; ++i) visit(expectedAt(volume, i, j, k));
        }
    }
}

class WriteAnalytic : public testing::TestWithParam<std::string> {
  protected:
    std::string rawBytes(const char* type) const {
        writeAnalytic(volume_, folder_ / "out.raw", options(kDims, type));
        EXPECT_EQ(folder_.count(), 1);
        return readBytes(folder_ / "out.raw");
    }

    test::TempFolder folder_;
    AnalyticVolume volume_ = makeAnalytic(GetParam(), 4, 0.1);
};
INSTANTIATE_TEST_SUITE_P(Names, WriteAnalytic, testing::ValuesIn(analyticNames()),
                         [](const auto& info) {
                             return std::string(1, info.param[0]) + std::to_string(info.index);
                         });

constexpr std::size_t kVoxels = std::size_t(kDims.x) * kDims.y * kDims.z;

TEST_P(WriteAnalytic, EightBitRawIsRoundedToNearest) {
    const std::string bytes = rawBytes("uint8");
    ASSERT_EQ(bytes.size(), kVoxels);
    EXPECT_TRUE(bytes == rawBytes(""));
    std::size_t at = 0;
    forVoxels(volume_, [&](double value) {
        ASSERT_EQ(std::uint8_t(bytes[at++]), std::uint8_t(std::floor(value * 255 + 0.5)));
    });
}

TEST_P(WriteAnalytic, SixteenBitRawIsLittleEndian) {
    const std::string bytes = rawBytes("uint16");
    ASSERT_EQ(bytes.size(), 2 * kVoxels);
    std::size_t at = 0;
    forVoxels(volume_, [&](double value) {
        const int stored = std::uint8_t(bytes[at]) + 256 * std::uint8_t(bytes[at + 1]);
        ASSERT_EQ(stored, int(std::floor(value * 65535 + 0.5)));
        at += 2;
    });
}

TEST_P(WriteAnalytic, FloatRawIsTheValueRoundedToFloat) {
    const std::string bytes = rawBytes("float32");
    ASSERT_EQ(bytes.size(), 4 * kVoxels);
    std::size_t at = 0;
    forVoxels(volume_, [&](double value) {
        float stored = 0;
        std::memcpy(&stored, &bytes[at], 4);
        ASSERT_EQ(stored, float(value));
        at += 4;
    });
}

std::vector<std::string> gridNames(const fs::path& name) {
    openvdb::initialize();
    openvdb::io::File file(name.string());
    file.open();
    std::vector<std::string> names;
    for (auto grid = file.beginName(); grid != file.endName(); ++grid) names.push_back(*grid);
    return names;
}

template <typename Grid = openvdb::FloatGrid>
typename Grid::Ptr readGrid(const fs::path& name, const std::string& gridName = "density") {
    openvdb::initialize();
    openvdb::io::File file(name.string());
    file.open(/*delayLoad=*/false);
    const auto grid = openvdb::gridPtrCast<Grid>(file.readGrid(gridName));
    EXPECT_TRUE(grid) << gridName;
    file.close();
    return grid;
}

// Every voxel of the grid is what `valueAt` says of its place, if `isThere` says that it counts.
template <typename Grid, typename ValueAt, typename IsThere>
void expectHolds(const Grid& grid, const ValueAt& valueAt, const IsThere& isThere) {
    using Value = typename Grid::ValueType;
    EXPECT_EQ(grid.background(), Value(0.0f));
    EXPECT_FALSE(grid.saveFloatAsHalf());
    EXPECT_EQ(grid.indexToWorld(openvdb::Vec3d(3, 4, 5)), openvdb::Vec3d(3, 2, 10));
    const auto accessor = grid.getConstAccessor();
    std::uint64_t active = 0;
    for (int k = 0; k < kDims.z; ++k) {
        for (int j = 0; j < kDims.y; ++j) {
            for (int i = 0; i < kDims.x; ++i) {
                const openvdb::Coord at(i, j, k);
                const Value value = valueAt(placeOf(i, j, k));
                const bool there = isThere(placeOf(i, j, k), value);
                ASSERT_EQ(accessor.getValue(at), there ? value : Value(0.0f)) << at;
                ASSERT_EQ(accessor.isValueOn(at), there) << at;
                active += there;
            }
        }
    }
    EXPECT_EQ(grid.activeVoxelCount(), active);
}

TEST_P(WriteAnalytic, VdbHoldsTheFunctionsAtEveryVoxelAndNothingElse) {
    AnalyticFileOptions grids = options(kDims);
    grids.spacing = {1, 0.5, 2};
    const fs::path file = folder_ / "out.vdb";
    writeAnalytic(volume_, file, grids);
    EXPECT_EQ(folder_.count(), 1);
    EXPECT_EQ(gridNames(file).size(), 1 + volume_.others.size() + (volume_.colorAt ? 1 : 0));
    const auto scalar = [&](const std::string& name, const auto& valueAt, double threshold) {
        const auto grid = readGrid(file, name);
        ASSERT_TRUE(grid);
        EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
        expectHolds(
            *grid, [&](const glm::dvec3& p) { return float(valueAt(p)); },
            [&](const glm::dvec3&, float value) { return value > threshold; });
    };
    scalar("density", volume_.valueAt, 0);
    for (const AnalyticGrid& other : volume_.others)
        scalar(other.name, other.valueAt, other.threshold);
    if (!volume_.colorAt) return;
    expectHolds(
        *readGrid<openvdb::Vec3SGrid>(file, "Cd"),
        [&](const glm::dvec3& p) {
            const glm::vec3 color(volume_.colorAt(p));
            return openvdb::Vec3s(color.r, color.g, color.b);
        },
        [&](const glm::dvec3& p, const openvdb::Vec3s&) { return float(volume_.valueAt(p)) != 0; });
}

TEST_P(WriteAnalytic, SameBytesOnAnyNumberOfThreads) {
    for (const std::string extension : {".raw", ".vdb"}) {
        for (const char* threads : {"1", "2"}) {
            const ThreadLimit limit(std::stoi(threads));
            writeAnalytic(volume_, folder_ / (threads + extension), options({40, 40, 40}));
        }
        const std::string bytes = readBytes(folder_ / ("1" + extension));
        EXPECT_GT(bytes.size(), 500u);
        EXPECT_TRUE(bytes == readBytes(folder_ / ("2" + extension))) << extension;
    }
}

TEST(WriteAnalyticVdb, TagsFilesByContent) {
    const test::TempFolder folder;
    const auto write = [&](std::uint64_t seed) {
        writeAnalytic(makeAnalytic("cloud", seed), folder / "out.vdb", options({16, 16, 16}));
        openvdb::io::File file((folder / "out.vdb").string());
        file.open();
        EXPECT_EQ(file.getUniqueTag().size(), 36u);
        return file.getUniqueTag();
    };
    openvdb::initialize();
    const std::string tag = write(1);
    EXPECT_EQ(tag, write(1));
    EXPECT_NE(tag, write(2));
    EXPECT_EQ(tag[14], '8');  // a UUID of version 8
}

TEST(WriteAnalyticVdb, KeepsConstantBlocksAsTiles) {
    const test::TempFolder folder;
    writeAnalytic(makeAnalytic("slab"), folder / "out.vdb", options({80, 80, 80}));
    const auto grid = readGrid(folder / "out.vdb");
    EXPECT_EQ(grid->activeVoxelCount(), 64u * 64 * 40);
    EXPECT_GT(grid->tree().activeTileCount(), 0u);
    EXPECT_LT(grid->tree().leafCount(), 8u * 8 * 6);
}

// Where smoke is equally thick throughout, its colour is not.
TEST(WriteAnalyticVdb, ColoursAreWhereTheDensityIs) {
    const test::TempFolder folder;
    const AnalyticVolume volume = makeAnalytic("explosion");
    writeAnalytic(volume, folder / "out.vdb", options(glm::ivec3(64)));
    const auto density = readGrid(folder / "out.vdb");
    const auto colors = readGrid<openvdb::Vec3SGrid>(folder / "out.vdb", "Cd");
    ASSERT_TRUE(density && colors);
    EXPECT_GT(density->tree().activeTileCount(), 0u);
    EXPECT_EQ(colors->activeVoxelCount(), density->activeVoxelCount());
    for (auto tile = density->tree().cbeginValueOn(); tile; ++tile) {
        if (tile.isVoxelValue()) continue;
        for (const int far : {0, 7}) {
            const openvdb::Coord at = tile.getBoundingBox().min().offsetBy(far, 0, 7 - far);
            const glm::dvec3 p = (2.0 * glm::dvec3(at.x(), at.y(), at.z()) + 1.0) / 64.0 - 1.0;
            const glm::vec3 color(volume.colorAt(p));
            EXPECT_EQ(colors->tree().getValue(at), openvdb::Vec3s(color.r, color.g, color.b));
            EXPECT_TRUE(colors->tree().isValueOn(at));
        }
    }
}

TEST(WriteAnalyticRaw, SaysWhatItLeavesOut) {
    const test::TempFolder folder;
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& line) { warnings.push_back(line); };
    const auto write = [&](const char* name, const fs::path& file) {
        warnings.clear();
        writeAnalytic(makeAnalytic(name), file, options(kDims), listener);
        return warnings;
    };
    using Lines = std::vector<std::string>;
    const fs::path raw = folder / "out.raw";
    const std::string begin = raw.string() + ": holds density alone; left out ";
    EXPECT_EQ(write("fire", raw), Lines{begin + "temperature, flame, which a .vdb holds"});
    EXPECT_EQ(write("explosion", raw), Lines{begin + "temperature, Cd, which a .vdb holds"});
    EXPECT_EQ(write("cloud", raw), Lines());
    EXPECT_EQ(write("fire", folder / "out.vdb"), Lines());
}

TEST(WriteAnalyticFile, NoticesAFullDevice) {
    const test::TempFolder folder;
    for (const char* name : {"out.raw", "out.vdb"}) {
        const fs::path link = folder / name;
        fs::create_symlink("/dev/full", link);
        EXPECT_EQ(errorOf([&] { writeAnalytic(makeAnalytic("slab"), link, options(kDims)); }),
                  "output: " + link.string() + ": cannot be written: No space left on device");
        EXPECT_EQ(fs::read_symlink(link), "/dev/full");
    }
    EXPECT_EQ(folder.count(), 2);
}

TEST(WriteAnalyticFile, NoticesALimitAnywhereInTheFile) {
    const test::TempFolder folder;
    const AnalyticVolume volume = makeAnalytic("cloud");
    for (const char* name : {"out.raw", "out.vdb"}) {
        const fs::path file = folder / name;
        writeAnalytic(volume, file, options({32, 32, 32}));
        const std::uintmax_t whole = fs::file_size(file);
        fs::remove(file);
        for (const std::uintmax_t bytes : {std::uintmax_t(0), whole / 2, whole - 1}) {
            std::string error;
            {
                const test::FileSizeLimit limit(bytes);
                error = errorOf([&] { writeAnalytic(volume, file, options({32, 32, 32})); });
            }
            EXPECT_EQ(error, "output: " + file.string() + ": cannot be written: File too large");
            EXPECT_EQ(folder.count(), 0);
        }
    }
}

TEST(WriteAnalyticFile, RefusesWhatItCannotWrite) {
    const auto error = [](const fs::path& file, const AnalyticFileOptions& wrong) {
        return errorOf([&] { writeAnalytic(makeAnalytic("slab"), file, wrong); });
    };
    EXPECT_EQ(error("out.raw", options({0, 4, 4})),
              "usage: `dims`: got 0x4x4; expected three numbers of at least 1");
    EXPECT_EQ(error("out.vdb", options({4, 4, -1})),
              "usage: `dims`: got 4x4x-1; expected three numbers of at least 1");
    EXPECT_EQ(error("out.raw.gz", options(kDims)),
              "usage: out.raw.gz: got extension \".gz\"; expected .raw or .vdb");
    EXPECT_EQ(error("out.raw", options(kDims, "int8")),
              "usage: `type`: got \"int8\"; expected uint8, uint16 or float32 for .raw");
    EXPECT_EQ(error("out.vdb", options(kDims, "uint8")),
              "usage: `type`: got \"uint8\"; expected float32 for .vdb");
    AnalyticFileOptions flat = options(kDims);
    flat.spacing = {1, 0, 2.5};
    EXPECT_EQ(error("out.vdb", flat),
              "usage: `spacing`: got 1,0,2.5; expected three numbers above 0");
    EXPECT_EQ(
        error("no_such_folder/out.vdb", options(kDims)),
        "output: no_such_folder/out.vdb: cannot be written: there is no folder no_such_folder");
    EXPECT_EQ(
        error("no_such_folder/out.raw", options(kDims)),
        "output: no_such_folder/out.raw: cannot be written: there is no folder no_such_folder");
}

TEST(WriteAnalyticFile, ReportsProgressAndCanBeStopped) {
    const test::TempFolder folder;
    for (const char* name : {"out.raw", "out.vdb"}) {
        double share = 0;
        Listener listener;
        listener.progress = [&](double now) {
            EXPECT_GE(now, share);
            share = now;
        };
        writeAnalytic(makeAnalytic("explosion"), folder / name, options({32, 32, 32}), listener);
        EXPECT_EQ(share, 1);
        share = 0;
        writeAnalytic(makeAnalytic("slab"), folder / name, options({32, 32, 32}), listener);
        EXPECT_EQ(share, 1);
        fs::remove(folder / name);

        listener.progress = [](double now) {
            if (now > 0.5) throw Error(ErrorCode::kInterrupted, "interrupted");
        };
        EXPECT_EQ(
            errorOf([&] {
                writeAnalytic(makeAnalytic("slab"), folder / name, options({32, 32, 32}), listener);
            }),
            "interrupted: interrupted");
        EXPECT_EQ(folder.count(), 0);
    }
}

// A voxel is the mean of what is true at even places in it.
TEST(WriteAnalyticSamples, AreAveraged) {
    const AnalyticVolume volume = makeAnalytic("marschner-lobb");
    test::TempFolder folder;
    AnalyticFileOptions three = options(kDims, "float32");
    three.samples = 3;
    writeAnalytic(volume, folder / "out.raw", three);
    const std::string bytes = readBytes(folder / "out.raw");
    for (const glm::ivec3& index :
         {glm::ivec3(0, 0, 0), glm::ivec3(20, 12, 9), glm::ivec3(7, 3, 5)}) {
        double sum = 0;
        for (const double x : {1.0, 3.0, 5.0}) {
            for (const double y : {1.0, 3.0, 5.0}) {
                for (const double z : {1.0, 3.0, 5.0}) {
                    const glm::dvec3 sixths = 6.0 * glm::dvec3(index) + glm::dvec3(x, y, z);
                    sum += volume.valueAt(sixths / (3.0 * glm::dvec3(kDims)) - 1.0);
                }
            }
        }
        float stored = 0;
        const int place = (index.z * kDims.y + index.y) * kDims.x + index.x;
        std::memcpy(&stored, &bytes[4 * std::size_t(place)], 4);
        EXPECT_NEAR(stored, sum / 27, 1e-6);
    }
    three.samples = 17;
    EXPECT_EQ(errorOf([&] { writeAnalytic(volume, folder / "out.raw", three); }),
              "usage: `samples`: got 17; expected a whole number within 1..16");
}

// Averages count, not single samples: what is cold is not nothing.
TEST(WriteAnalyticSamples, AreAveragedBeforeTheThreshold) {
    const test::TempFolder folder;
    AnalyticVolume volume{"steps", [](const glm::dvec3&) { return 1.0; }};
    // Samples of a voxel of 1 are -0.5 and 0.5 along each axis.
    const auto valueAt = [](const glm::dvec3& p) { return p.x < 0 ? 300.0 : 900.0; };
    volume.others = {{"warm", valueAt, 590}, {"hot", valueAt, 600}};
    volume.colorAt = [](const glm::dvec3& p) { return glm::dvec3(p.x < 0 ? 0 : 1, 0.5, 0.25); };
    AnalyticFileOptions two = options(glm::ivec3(1));
    two.samples = 2;
    const fs::path file = folder / "out.vdb";
    writeAnalytic(volume, file, two);
    const openvdb::Coord at(0, 0, 0);
    EXPECT_EQ(readGrid(file, "warm")->tree().getValue(at), 600);
    EXPECT_EQ(readGrid(file, "hot")->activeVoxelCount(), 0u);
    EXPECT_EQ(readGrid<openvdb::Vec3SGrid>(file, "Cd")->tree().getValue(at),
              openvdb::Vec3s(0.5f, 0.5f, 0.25f));
}

}  // namespace
}  // namespace deltasplat
