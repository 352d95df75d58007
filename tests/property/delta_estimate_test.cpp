// SPDX-License-Identifier: Apache-2.0
// What a volume is expected to take as a delta grid is near what it takes.
#include "deltasplat/delta/delta_estimate.h"
#include "ingest/grids/tree_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using testing::TempFolder;

Volume readKept(const std::string& file) {
    ReadOptions reading;
    reading.keepSource = true;
    return readVolume(file, reading);
}

double deltaBytes(const Volume& volume, bool pack) {
    DeltaFileOptions options;
    options.sliceAxis = 2;
    options.pack = pack;
    DeltaFile file;
    file.add(volume, options);
    file.write("delta.vdb");
    return double(fs::file_size("delta.vdb"));
}

// Within a fifteenth, of few and of many blocks.
void expectNear(const std::string& file, bool readsByBlocks, bool isSampled) {
    SCOPED_TRACE(file);
    const Volume volume = readKept(file);
    const std::optional<DeltaEstimate> estimate = estimateDeltaFile(volume, 2);
    ASSERT_TRUE(estimate);
    EXPECT_EQ(estimate->readsByBlocks, readsByBlocks);
    EXPECT_EQ(estimate->sampled < 0.5, isSampled);
    EXPECT_LE(estimate->sampled, 1);
    writeVolumes("plain.vdb", {volume});
    EXPECT_NEAR(estimate->plainBytes / double(fs::file_size("plain.vdb")), 1, 0.07);
    EXPECT_NEAR(estimate->voxelBytes / deltaBytes(volume, false), 1, 0.07);
    EXPECT_NEAR(estimate->deltaBytes / deltaBytes(volume, true), 1, 0.07);
}

TEST(DeltaEstimate, DenseVolumesOfBytes) {
    const TempFolder folder;
    std::mt19937 random(1);
    for (const int size : {40, 168}) {
        std::string voxels;
        for (int z = 0; z < size; ++z) {
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    const double wave = std::sin(x * 0.1) * std::cos(y * 0.07 + z * 0.02);
                    voxels += char(wave < 0 ? 0 : int(wave * 200) + int(random() % 9));
                }
            }
        }
        const std::string dims = std::to_string(size);
        const std::string file = "a_" + dims + "x" + dims + "x" + dims + "_uint8.raw";
        testing::writeBytes(file, voxels);
        expectNear(file, true, size > 100);
    }
}

TEST(DeltaEstimate, FloatsInPartsOfSpace) {
    const TempFolder folder;
    openvdb::initialize();
    std::mt19937 random(2);
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    for (auto at = openvdb::CoordBBox(openvdb::Coord(-90), openvdb::Coord(89)).begin(); at; ++at) {
        const double away = (*at).asVec3d().length() - 80;
        if (away < 0) grid->tree().setValueOn(*at, float(1 - away + double(random()) * 1e-11));
    }
    openvdb::io::File("a.vdb").write({grid});
    expectNear("a.vdb", false, true);
    // In halves deltas are of codes.
    grid->setSaveFloatAsHalf(true);
    openvdb::io::File("a.vdb").write({grid});
    expectNear("a.vdb", true, true);
}

TEST(DeltaEstimate, OfWhatNothingIsSaid) {
    const TempFolder folder;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    openvdb::io::File("a.vdb").write({grid});
    EXPECT_FALSE(estimateDeltaFile(readKept("a.vdb"), 2));
    // A region that would have to be gone through block by block.
    grid->tree().addTile(3, openvdb::Coord(0), 1.0f, true);
    openvdb::io::File("a.vdb").write({grid});
    EXPECT_FALSE(estimateDeltaFile(readKept("a.vdb"), 2));
    // Codes that are not exact, without what they stand for.
    std::mt19937 random(3);
    std::string voxels;
    for (int i = 0; i < 64 * 64 * 32; ++i) {
        const auto value = float(random());
        voxels.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    testing::writeBytes("a_64x64x32_float32.raw", voxels);
    EXPECT_FALSE(estimateDeltaFile(readVolume("a_64x64x32_float32.raw"), 2));
    EXPECT_TRUE(estimateDeltaFile(readKept("a_64x64x32_float32.raw"), 2));
}

}  // namespace
}  // namespace deltasplat
