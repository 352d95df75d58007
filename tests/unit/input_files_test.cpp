// SPDX-License-Identifier: Apache-2.0
#include "formats/input_files.h"

#include <gtest/gtest.h>

#include "deltasplat/ingest/read_volume.h"
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

void expectConfined(const std::string& input, bool inside) {
    if (inside) {
        EXPECT_NO_THROW(requireConfined(input)) << input;
    } else {
        EXPECT_THROW(requireConfined(input), Error) << input;
    }
}

TEST(InputFiles, ConfinedToTheirFolder) {
    const TempFolder folder;
    std::filesystem::create_directories("up/in/sub");
    for (const char* const name : {"up/x.raw", "up/in/x.raw", "up/in/sub/x.raw", "up/inner.raw"}) {
        writeBytes(name, "1234");
    }
    const std::string absolute = std::filesystem::absolute("up/in/x.raw").string();
    std::filesystem::create_symlink("../x.raw", "up/in/out_link.raw");
    std::filesystem::create_symlink("sub/x.raw", "up/in/in_link.raw");
    std::filesystem::create_directory_symlink("..", "up/in/up_link");
    const std::vector<std::pair<std::string, bool>> cases{
        {"x.raw", true},           {"sub/x.raw", true},        {"sub/../x.raw", true},
        {absolute, true},          {"in_link.raw", true},      {"../x.raw", false},
        {"../inner.raw", false},   {"/etc/passwd", false},     {"out_link.raw", false},
        {"up_link/x.raw", false},  {"sub/../../x.raw", false}, {"../in/x.raw", true},
        {"../nowhere.raw", false}, {"nowhere.raw", true}};
    for (const auto& [name, inside] : cases) {
        writeBytes("up/in/a.nhdr", "NRRD0004\nsizes: 2 2 1\ndata file: " + name + "\n");
        writeBytes("up/in/a.mhd", "DimSize = 2 2 1\nElementDataFile = " + name + "\n");
        expectConfined("up/in/a.nhdr", inside);
        expectConfined("up/in/a.mhd", inside);
    }
    // Inputs of one file or several that are links themselves.
    expectConfined("up/in/x.raw", true);
    expectConfined("up/in/in_link.raw", true);
    expectConfined("up/in/out_link.raw", false);
    std::filesystem::create_directory("up/stack");
    writeBytes("up/stack/s1.pgm", "P5");
    expectConfined("up/stack", true);
    std::filesystem::create_symlink("../x.raw", "up/stack/s2.pgm");
    expectConfined("up/stack", false);
    expectConfined("up/stack/s#.pgm", false);
}

TEST(InputFiles, ReadersConfineWhenAsked) {
    const TempFolder folder;
    std::filesystem::create_directory("in");
    writeBytes("x.raw", "1234");
    std::filesystem::create_symlink("../x.raw", "in/a.raw");
    ReadOptions options;
    options.raw.dims = {2, 2, 1};
    options.raw.type = "uint8";
    EXPECT_EQ(readVolume("in/a.raw", options).activeCount(), 4u);
    confineInputs();
    expectError(ErrorCode::kInput,
                "in/a.raw: got the file in/a.raw outside of its folder; expected files inside of "
                "it (`confineInputs`)",
                [&] { readVolume("in/a.raw", options); });

    // What a pattern finds is confined to the pattern's own folder.
    std::filesystem::create_directories("up/own");
    std::filesystem::create_directory_symlink("../in", "up/out");
    std::filesystem::create_directory_symlink("own", "up/round");
    EXPECT_NO_THROW(requireFoundIn("up", "up/own/x.raw"));
    EXPECT_NO_THROW(requireFoundIn("up", "up/round/x.raw"));
    EXPECT_NO_THROW(requireFoundIn("up", "up/own"));
    EXPECT_NO_THROW(requireFoundIn("", "in/a.raw"));
    EXPECT_NO_THROW(requireFoundIn("up/out", "up/out/a.raw"));
    expectError(ErrorCode::kInput,
                "up/out/a.raw: got a folder outside of up, in which the pattern looks; expected "
                "folders inside of it (`confineInputs`)",
                [] { requireFoundIn("up", "up/out/a.raw"); });
    EXPECT_THROW(requireFoundIn("up", "up/out"), Error);
    EXPECT_THROW(requireFoundIn("", "/"), Error);
}

}  // namespace
}  // namespace deltasplat
