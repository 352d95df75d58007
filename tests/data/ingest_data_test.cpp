// SPDX-License-Identifier: Apache-2.0
// Reads the real data sets; the expected numbers are those of their description, DATASETS.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

class IngestData : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::is_directory(kFolder)) GTEST_SKIP() << "no data sets in " << kFolder;
    }
    static Volume read(const std::string& file, const ReadOptions& options = {}) {
        return readVolume(kFolder / file, options);
    }
    static double zeroShare(const Volume& volume) {
        return double(volume.histogram()[volume.codeBook().codeOf(0)]) /
               double(volume.activeCount());
    }
    static std::vector<fs::path> files(const std::string& ending) {
        std::vector<fs::path> found;
        for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
            if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
        }
        std::sort(found.begin(), found.end());
        return found;
    }
    static void expectConsistent(const Volume& volume) {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : volume.histogram()) sum += count;
        EXPECT_EQ(sum, volume.activeCount());
        EXPECT_EQ(volume.codes()->tree().activeVoxelCount(), volume.activeCount());
        EXPECT_LE(volume.activeCount(), std::uint64_t(volume.box().voxels()));
    }
    inline static const fs::path kFolder = DELTASPLAT_SHARED_DATA;
};

TEST_F(IngestData, EveryRawFileWithANameIsRead) {
    int count = 0;
    for (const char* ending : {".raw", ".raw.gz"}) {
        for (const fs::path& file : files(ending)) {
            SCOPED_TRACE(file);
            // The two raw files of MetaImage pairs have neither dims nor type in their names.
            if (file.stem() == "MRknee_8bit" || file.stem() == "HeadMRVolume") {
                EXPECT_THROW(readVolume(file), Error);
                continue;
            }
            const Volume volume = readVolume(file);
            expectConsistent(volume);
            EXPECT_EQ(volume.activeCount(), std::uint64_t(volume.box().voxels()));
            ++count;
        }
    }
    EXPECT_GE(count, 15);
}

TEST_F(IngestData, EveryGridOfEveryVdbIsRead) {
    int count = 0;
    for (const fs::path& file : files(".vdb")) {
        SCOPED_TRACE(file);
        for (const Volume& volume : readAllVolumes(file)) {
            expectConsistent(volume);
            ++count;
        }
    }
    EXPECT_GE(count, 300);
}

TEST_F(IngestData, Fuel) {
    const Volume fuel = read("fuel/fuel_64x64x64_uint8.raw");
    EXPECT_EQ(fuel.box().dims(), glm::ivec3(64));
    EXPECT_NEAR(zeroShare(fuel), 0.95, 0.005);
}

TEST_F(IngestData, Engine) {
    const Volume engine = read("engine/engine_256x256x128_uint8.raw.gz");
    EXPECT_EQ(engine.box().dims(), glm::ivec3(256, 256, 128));
    EXPECT_NEAR(zeroShare(engine), 0.38, 0.005);
    std::uint64_t low = 0;
    for (int code = 0; code <= 10; ++code) low += engine.histogram()[std::size_t(code)];
    EXPECT_NEAR(double(low) / double(engine.activeCount()), 0.81, 0.005);
    // Slices 108 to 126 are empty: their whole blocks are tiles.
    for (int z = 112; z < 120; z += 8) {
        EXPECT_EQ(engine.codes()->tree().getValueDepth(openvdb::Coord(128, 128, z)), 2);
        EXPECT_EQ(engine.codes()->tree().getValue(openvdb::Coord(128, 128, z)), 0);
    }
}

TEST_F(IngestData, BigEndianScans) {
    const Volume head = read("ct_head/cthead_256x256x113_uint16be.raw.gz");
    EXPECT_EQ(head.valueMin(), 0);
    EXPECT_EQ(head.valueMax(), 3272);
    const Volume tooth = read("tooth/tooth_103x94x161_uint16be.raw.gz");
    EXPECT_EQ(tooth.box().dims(), glm::ivec3(103, 94, 161));
    EXPECT_EQ(tooth.valueMax(), 1300);
}

TEST_F(IngestData, AneurismIsSparse) {
    const Volume aneurism = read("aneurism/aneurism_256x256x256_uint8.raw.gz");
    EXPECT_NEAR(zeroShare(aneurism), 0.99, 0.005);
    EXPECT_LT(aneurism.codes()->tree().leafCount(), 32768u / 4);
}

TEST_F(IngestData, Smoke) {
    const Volume smoke = read("vdb_smoke/smoke.vdb");
    EXPECT_EQ(smoke.name(), "density");
    EXPECT_EQ(smoke.type(), "half");
    EXPECT_EQ(smoke.gridClass(), "fog volume");
    EXPECT_EQ(smoke.box().dims(), glm::ivec3(111, 222, 112));
    EXPECT_EQ(smoke.activeCount(), 1049275u);
    EXPECT_NEAR(smoke.valueMin(), 0.00001, 1e-6);
    EXPECT_NEAR(smoke.valueMax(), 5.71, 0.005);
    EXPECT_NEAR(smoke.voxelSize().y, 0.476, 0.0005);
    EXPECT_EQ(smoke.codeBook().kind, CodeBook::Kind::kHalf);
}

TEST_F(IngestData, LevelSetSphere) {
    const std::string file = "vdb_level_set_sphere/sphere.vdb";
    ReadOptions options;
    options.levelSetToFog = false;
    const Volume kept = read(file, options);
    EXPECT_EQ(kept.gridClass(), "level set");
    EXPECT_EQ(kept.box().dims(), glm::ivec3(125));
    EXPECT_EQ(kept.activeCount(), 270638u);
    EXPECT_NEAR(kept.valueMin(), -0.15, 0.0005);
    EXPECT_NEAR(kept.valueMax(), 0.15, 0.0005);
    const Volume fog = read(file);
    EXPECT_EQ(fog.gridClass(), "fog volume");
    EXPECT_NEAR(fog.valueMax(), 1, 1e-12);
    // A ball of radius 59.5 to 60 voxels, by its volume.
    EXPECT_NEAR(double(fog.activeCount()), 4.0 / 3 * 3.14159265 * 60 * 60 * 60, 4000);
}

TEST_F(IngestData, AnisotropicFogKeepsItsTiles) {
    const Volume fog = read("vdb_anisotropic_fog/test.vdb");
    EXPECT_EQ(fog.box().dims(), glm::ivec3(109, 95, 99));
    EXPECT_EQ(fog.activeCount(), 271492u);
    EXPECT_GT(fog.codes()->tree().activeTileCount(), 0u);
    EXPECT_NEAR(fog.voxelSize().x, 0.01, 1e-9);
    EXPECT_NEAR(fog.voxelSize().y, 0.02, 1e-9);
    EXPECT_NEAR(fog.voxelSize().z, 0.01, 1e-9);
}

TEST_F(IngestData, TwoScalarGrids) {
    const auto grids = readAllVolumes(kFolder / "vdb_density_heat/densityAndHeat.vdb");
    ASSERT_EQ(grids.size(), 2u);
    EXPECT_EQ(grids[0].name(), "density");
    EXPECT_EQ(grids[0].activeCount(), 6124u);
    EXPECT_EQ(grids[0].box().dims(), glm::ivec3(23, 23, 42));
    EXPECT_EQ(grids[1].name(), "heat");
    EXPECT_EQ(grids[1].activeCount(), 5224u);
}

TEST_F(IngestData, SequenceThatStartsEmpty) {
    EXPECT_TRUE(read("vdb_usd_smoke_seq/smoke_000001.vdb").empty());
    EXPECT_EQ(read("vdb_usd_smoke_seq/smoke_000002.vdb").box().dims(), glm::ivec3(51, 49, 80));
    EXPECT_EQ(read("vdb_usd_smoke_seq/smoke_000003.vdb").box().dims(), glm::ivec3(51, 49, 96));
}

TEST_F(IngestData, ExhaustSequence) {
    ReadOptions options;
    options.gridName = "density";
    const Volume first = read("vdb_exhaust_seq/fluid_data_0001.vdb", options);
    EXPECT_EQ(first.box().dims(), glm::ivec3(11, 9, 28));
    EXPECT_EQ(first.activeCount(), 1665u);
    const Volume last = read("vdb_exhaust_seq/fluid_data_0010.vdb", options);
    EXPECT_EQ(last.box().dims(), glm::ivec3(51, 71, 29));
    EXPECT_EQ(last.activeCount(), 39375u);
    options.gridName = "flags";
    EXPECT_EQ(read("vdb_exhaust_seq/fluid_data_0010.vdb", options).type(), "int32");
}

TEST_F(IngestData, PlumeIsActiveEverywhere) {
    ReadOptions options;
    options.gridName = "density";
    const Volume plume = read("vdb_plume_seq/fluid_data_0190.vdb", options);
    EXPECT_EQ(plume.box().dims(), glm::ivec3(29, 29, 32));
    EXPECT_EQ(plume.activeCount(), 29u * 29 * 32);
    EXPECT_EQ(plume.type(), "half");
}

}  // namespace
}  // namespace deltasplat
