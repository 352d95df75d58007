// SPDX-License-Identifier: Apache-2.0
// Converts every data set to .vdb and compares what OpenVDB alone reads from it with the source.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "unit/convert_helpers.h"
#include "unit/vdb_compare.h"
#include "volume/code_tree.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {
namespace {

namespace fs = std::filesystem;

class ConvertData : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::is_directory(kFolder)) GTEST_SKIP() << "no data sets in " << kFolder;
    }
    static std::vector<fs::path> files(const std::string& ending) {
        std::vector<fs::path> found;
        for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
            if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
        }
        std::sort(found.begin(), found.end());
        return found;
    }
    static void printSizes(const fs::path& in, const fs::path& out) {
        std::printf("%s: %llu -> %llu bytes\n", in.filename().c_str(),
                    (unsigned long long)fs::file_size(in), (unsigned long long)fs::file_size(out));
    }
    inline static const fs::path kFolder = DELTASPLAT_SHARED_DATA;
};

bool isScalar(const openvdb::GridBase& grid) {
    return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>() ||
           grid.isType<openvdb::Int32Grid>() || grid.isType<openvdb::Int64Grid>() ||
           grid.isType<openvdb::BoolGrid>() || grid.isType<openvdb::MaskGrid>();
}

TEST_F(ConvertData, EveryVdbKeepsEverything) {
    const TempFolder folder;
    int grids = 0;
    for (const fs::path& file : files(".vdb")) {
        SCOPED_TRACE(file);
        ReadOptions options;
        options.keepSource = true;
        options.levelSetToFog = false;
        const WriteReport report = writeVolumes("out.vdb", readAllVolumes(file, options));
        EXPECT_EQ(report.notes, std::vector<std::string>{});
        EXPECT_TRUE(report.lossless);
        printSizes(file, "out.vdb");
        std::map<std::string, openvdb::GridBase::Ptr> back;
        for (const auto& grid : readGrids("out.vdb")) back[grid->getName()] = grid;
        for (const auto& grid : readGrids(file)) {
            if (!isScalar(*grid)) continue;
            SCOPED_TRACE(grid->getName());
            ASSERT_TRUE(back.count(grid->getName()));
            const openvdb::GridBase& written = *back[grid->getName()];
            expectSameGrid(*grid, written);
            // What was stored in halves is again.
            const bool real = grid->isType<openvdb::FloatGrid>();
            if (real && grid->saveFloatAsHalf()) {
                EXPECT_TRUE(written.saveFloatAsHalf());
            }
            ++grids;
        }
    }
    EXPECT_GE(grids, 300);
}

TEST_F(ConvertData, EveryRawFileKeepsItsVoxelsAndComesBack) {
    const TempFolder folder;
    int count = 0;
    for (const char* const ending : {".raw", ".raw.gz"}) {
        for (const fs::path& file : files(ending)) {
            SCOPED_TRACE(file);
            if (file.filename().string().find("uint") == std::string::npos) continue;
            const Volume volume = readKept(file);
            write("out.vdb", volume);
            printSizes(file, "out.vdb");
            const auto grid = readGrid<openvdb::FloatGrid>("out.vdb");
            ASSERT_TRUE(grid);
            EXPECT_EQ(grid->saveFloatAsHalf(), volume.valueMax() <= 2048);
            EXPECT_TRUE(grid->tree().hasSameTopology(volume.codes()->tree()));
            EXPECT_EQ(grid->activeVoxelCount(), std::uint64_t(volume.box().voxels()));
            std::uint64_t wrong = 0;
            for (auto code = volume.codes()->tree().cbeginValueOn(); code; ++code) {
                const double value = volume.codeBook().valueOf(*code);
                if (double(grid->tree().getValue(code.getCoord())) != value) ++wrong;
            }
            EXPECT_EQ(wrong, 0u);

            write("direct.raw", volume);
            write("back.raw", readKept("out.vdb"));
            WriteOptions sparse;
            sparse.dropBackground = true;
            write("sparse.vdb", volume, sparse);
            write("sparse.raw", readKept("sparse.vdb"));
            const std::string bytes = readBytes("direct.raw");
            EXPECT_TRUE(readBytes("back.raw") == bytes);
            EXPECT_TRUE(readBytes("sparse.raw") == bytes);
            ++count;
        }
    }
    EXPECT_GE(count, 15);
}

}  // namespace
}  // namespace deltasplat::testing
