// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/synth/write_analytic.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstdint>
#include <cstring>

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

double expectedAt(const AnalyticVolume& volume, int i, int j, int k) {
    return volume.valueAt(
        {(2.0 * i + 1) / kDims.x - 1, (2.0 * j + 1) / kDims.y - 1, (2.0 * k + 1) / kDims.z - 1});
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

openvdb::FloatGrid::Ptr readGrid(const fs::path& name) {
    openvdb::initialize();
    openvdb::io::File file(name.string());
    file.open(/*delayLoad=*/false);
    EXPECT_TRUE(file.hasGrid("density"));
    EXPECT_EQ(file.getGrids()->size(), 1u);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
    file.close();
    return grid;
}

TEST_P(WriteAnalytic, VdbHoldsTheFunctionAtEveryVoxelAndNothingElse) {
    AnalyticFileOptions grids = options(kDims);
    grids.spacing = {1, 0.5, 2};
    writeAnalytic(volume_, folder_ / "out.vdb", grids);
    EXPECT_EQ(folder_.count(), 1);
    const auto grid = readGrid(folder_ / "out.vdb");
    EXPECT_EQ(grid->background(), 0.0f);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_FALSE(grid->saveFloatAsHalf());
    EXPECT_EQ(grid->indexToWorld(openvdb::Vec3d(3, 4, 5)), openvdb::Vec3d(3, 2, 10));

    const auto accessor = grid->getConstAccessor();
    std::uint64_t active = 0;
    for (int k = 0; k < kDims.z; ++k) {
        for (int j = 0; j < kDims.y; ++j) {
            for (int i = 0; i < kDims.x; ++i) {
                const float expected = float(expectedAt(volume_, i, j, k));
                const openvdb::Coord at(i, j, k);
                ASSERT_EQ(accessor.getValue(at), expected) << at;
                ASSERT_EQ(accessor.isValueOn(at), expected != 0) << at;
                active += expected != 0;
            }
        }
    }
    EXPECT_EQ(grid->activeVoxelCount(), active);
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
    EXPECT_EQ(error("no_such_folder/out.vdb", options(kDims)),
              "output: no_such_folder/out.vdb: cannot be written: No such file or directory");
    EXPECT_EQ(error("no_such_folder/out.raw", options(kDims)),
              "output: no_such_folder/out.raw: cannot be written: No such file or directory");
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

}  // namespace
}  // namespace deltasplat
