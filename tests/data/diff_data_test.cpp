// SPDX-License-Identifier: Apache-2.0
// Compares the real data sets with themselves, with one voxel changed, and with their neighbours in
// a sequence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "support/changed_volume.h"
#include "support/kept_grid.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using testing::keptGrid;

class DiffData : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::is_directory(kFolder)) GTEST_SKIP() << "no data sets in " << kFolder;
    }
    static std::vector<fs::path> files(const fs::path& folder, const std::string& ending) {
        std::vector<fs::path> found;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
        }
        std::sort(found.begin(), found.end());
        return found;
    }
    static Volume read(const fs::path& file, const std::string& grid = {}) {
        ReadOptions options;
        options.gridName = grid;
        options.levelSetToFog = false;
        options.keepSource = true;
        return readVolume(file, options);
    }
    inline static const fs::path kFolder = DELTASPLAT_SHARED_DATA;
};

// The places and codes are random, but the same in every run.
glm::ivec3 randomPlace(const IndexBox& box, std::mt19937& random) {
    glm::ivec3 place;
    for (int axis = 0; axis < 3; ++axis) {
        place[axis] = std::uniform_int_distribution(box.min[axis], box.max[axis])(random);
    }
    return place;
}

void expectOneChange(const VolumeComparison& result, const glm::ivec3& at, double before,
                     double after) {
    EXPECT_EQ(result.maxAt, at);
    EXPECT_EQ(result.valueA, before);
    EXPECT_EQ(result.valueB, after);
    EXPECT_EQ(result.maxError, std::fabs(after - before));
    EXPECT_EQ(result.overFail, 1U);
    EXPECT_EQ(result.activeMismatch, 0U);
    EXPECT_DOUBLE_EQ(result.meanError, result.maxError / double(result.voxels));
    EXPECT_DOUBLE_EQ(result.rmsError, result.maxError / std::sqrt(double(result.voxels)));
    EXPECT_FALSE(result.equal());
}

TEST_F(DiffData, OneVoxelOfEveryRawFileIsFound) {
    std::mt19937 random(5);
    int count = 0;
    for (const char* ending : {"uint8.raw", "uint8.raw.gz", "uint16be.raw.gz"}) {
        for (const fs::path& file : files(kFolder, ending)) {
            SCOPED_TRACE(file);
            const Volume volume = read(file);
            const VolumeComparison same = compareVolumes(volume, volume);
            EXPECT_TRUE(same.equal());
            EXPECT_EQ(same.voxels, volume.activeCount());

            const glm::ivec3 at = randomPlace(volume.box(), random);
            const Coord place(at.x, at.y, at.z);
            auto codes = std::make_shared<CodeTree>(*volume.codes());
            const Code before = codes->tree().getValue(place);
            const Code after = Code(before ^ (1 + random() % 100));
            codes->tree().setValueOn(place, after);
            Volume changed = volume;
            test::changed(changed)->codes = codes;
            expectOneChange(compareVolumes(volume, changed), at, volume.codeBook().valueOf(before),
                            volume.codeBook().valueOf(after));
            ++count;
        }
    }
    EXPECT_GE(count, 15);
}

TEST_F(DiffData, OneVoxelOfEveryFloatGridIsFound) {
    int count = 0;
    for (const char* folder :
         {"vdb_smoke", "vdb_density_heat", "vdb_level_set_sphere", "vdb_anisotropic_fog"}) {
        for (const fs::path& file : files(kFolder / folder, ".vdb")) {
            for (const std::string& name : listGrids(file).scalar) {
                SCOPED_TRACE(file.string() + " " + name);
                const Volume volume = read(file, name);
                EXPECT_TRUE(compareVolumes(volume, read(file, name)).equal());

                const auto source = keptGrid<openvdb::FloatGrid>(volume);
                ASSERT_TRUE(source);
                const auto grid = source->deepCopy();
                auto voxel = grid->beginValueOn();
                for (std::uint64_t n = 0; n < volume.activeCount() / 2 && !voxel.isVoxelValue();) {
                    n += voxel.getVoxelCount();
                    ++voxel;
                }
                const Coord place = voxel.getCoord();
                const float before = grid->tree().getValue(place);
                grid->tree().setValueOn(place, before + 0.5F);
                Volume changed = volume;
                SourceGrid changedSource = *volume.source();
                changedSource.grid = fromOpenVdb(grid);
                test::changed(changed)->source = std::make_shared<SourceGrid>(changedSource);
                expectOneChange(compareVolumes(volume, changed), {place.x(), place.y(), place.z()},
                                before, before + 0.5F);
                ++count;
            }
        }
    }
    EXPECT_GE(count, 5);
}

// The comparison of two frames against OpenVDB's own iterators over their active voxels.
TEST_F(DiffData, FramesOfASequence) {
    const std::vector<fs::path> frames = files(kFolder / "vdb_exhaust_seq", ".vdb");
    ASSERT_GE(frames.size(), 2U);
    for (std::size_t i = 0; i + 1 < frames.size(); i += 3) {
        SCOPED_TRACE(frames[i]);
        const Volume a = read(frames[i], "density");
        const Volume b = read(frames[i + 1], "density");
        const auto gridA = keptGrid<openvdb::FloatGrid>(a);
        const auto gridB = keptGrid<openvdb::FloatGrid>(b);
        openvdb::BoolTree either(gridA->tree(), false, true, openvdb::TopologyCopy());
        either.topologyUnion(gridB->tree());
        std::uint64_t mismatch = 0;
        double largest = 0;
        for (auto voxel = either.cbeginValueOn(); voxel; ++voxel) {
            for (const Coord& at : voxel.getBoundingBox()) {
                mismatch += gridA->tree().isValueOn(at) != gridB->tree().isValueOn(at);
                const double error =
                    double(gridA->tree().getValue(at)) - gridB->tree().getValue(at);
                largest = std::max(largest, std::fabs(error));
            }
        }
        const VolumeComparison result = compareVolumes(a, b);
        EXPECT_EQ(result.voxels, either.activeVoxelCount());
        EXPECT_EQ(result.activeMismatch, mismatch);
        EXPECT_EQ(result.maxError, largest);
        EXPECT_GT(result.maxError, 0);
        const VolumeComparison reversed = compareVolumes(b, a);
        EXPECT_EQ(reversed.meanError, result.meanError);
        EXPECT_EQ(reversed.rmsError, result.rmsError);
        EXPECT_EQ(reversed.maxAt, result.maxAt);
    }
}

}  // namespace
}  // namespace deltasplat
