// SPDX-License-Identifier: Apache-2.0
#include "ingest/input_files.h"

#include <gtest/gtest.h>

#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;
using Files = std::vector<std::filesystem::path>;

TEST(InputFiles, AHeaderAndItsDataFile) {
    const TempFolder folder;
    std::filesystem::create_directory("in");
    writeBytes("in/a.nhdr", "NRRD0004\nsizes: 2 3 4\nData File: b.raw\n");
    EXPECT_EQ(filesOf("in/a.nhdr"), (Files{"in/a.nhdr", "in/b.raw"}));
    writeBytes("a.mhd", "DimSize = 2 3 4\nElementDataFile = /far/b.raw\n");
    EXPECT_EQ(filesOf("a.mhd"), (Files{"a.mhd", "/far/b.raw"}));
}

TEST(InputFiles, AHeaderBeforeItsData) {
    const TempFolder folder;
    writeBytes("a.nrrd", "NRRD0004\nsizes: 2 3 4\n\ndata file: is voxels here\n");
    EXPECT_EQ(filesOf("a.nrrd"), Files{"a.nrrd"});
    writeBytes("a.mha", "DimSize = 2 3 4\nElementDataFile = LOCAL\nvoxels");
    EXPECT_EQ(filesOf("a.mha"), Files{"a.mha"});
}

TEST(InputFiles, TheImagesOfAStack) {
    const TempFolder folder;
    std::filesystem::create_directory("in");
    for (const char* const name : {"in/s9.pgm", "in/s10.pgm"}) writeBytes(name, "P5");
    const Files files = {"in/s9.pgm", "in/s10.pgm"};
    EXPECT_EQ(filesOf("in/s#.pgm"), files);
    writeBytes("in/notes.txt", "");
    EXPECT_EQ(filesOf("in"), files);
}

TEST(InputFiles, OfWhatCannotBeRead) {
    const TempFolder folder;
    writeBytes("a.nhdr", "no header");
    for (const char* const name : {"a.nhdr", "nowhere.vdb", "nowhere.#.png"}) {
        EXPECT_EQ(filesOf(name), Files{name});
    }
}

}  // namespace
}  // namespace deltasplat
