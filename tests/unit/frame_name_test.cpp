// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_name.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

std::string at(const std::string& name, int frame) {
    const std::optional<FrameName> found = FrameName::find(name);
    return found ? found->at(frame).string() : "no place";
}

TEST(FrameName, FillsPlacesOfAllKinds) {
    EXPECT_EQ(at("smoke.####.vdb", 7), "smoke.0007.vdb");
    EXPECT_EQ(at("smoke.#.vdb", 7), "smoke.7.vdb");
    EXPECT_EQ(at("smoke.%04d.vdb", 7), "smoke.0007.vdb");
    EXPECT_EQ(at("smoke.%d.vdb", 7), "smoke.7.vdb");
    EXPECT_EQ(at("smoke.@@@.vdb", 7), "smoke.007.vdb");
    EXPECT_EQ(at("smoke.@.vdb", 7), "smoke.7.vdb");
    EXPECT_EQ(at("smoke.$F4.vdb", 7), "smoke.0007.vdb");
    EXPECT_EQ(at("smoke.$F.vdb", 7), "smoke.7.vdb");
}

TEST(FrameName, TakesMoreDigitsThanPlaces) {
    EXPECT_EQ(at("s.##.vdb", 12345), "s.12345.vdb");
    EXPECT_EQ(at("s.%02d.vdb", 12345), "s.12345.vdb");
}

// As printf and with it most renderers.
TEST(FrameName, CountsASignAsADigit) {
    EXPECT_EQ(at("s.####.vdb", -5), "s.-005.vdb");
    EXPECT_EQ(at("s.%04d.vdb", -5), "s.-005.vdb");
    EXPECT_EQ(at("s.$F.vdb", -5), "s.-5.vdb");
}

// Unless there is a folder of that very name.
TEST(FrameName, FillsFoldersThatAreNotThere) {
    const test::TempFolder folder;
    const auto in = [&](const std::string& name) { return (folder / name).string(); };
    EXPECT_EQ(at("shot.##/a.####.vdb", 3), "shot.03/a.0003.vdb");
    for (const std::string name : {"job@farm", "take #2", "100%done", "cost$F", "a\\#b"}) {
        EXPECT_NE(at(in(name + "/a.##.vdb"), 3), in(name + "/a.03.vdb")) << name;
        std::filesystem::create_directory(folder / name);
        EXPECT_EQ(at(in(name + "/a.##.vdb"), 3), in(name + "/a.03.vdb")) << name;
        EXPECT_EQ(at(in(name + "/new@/a.vdb"), 3), in(name + "/new3/a.vdb")) << name;
        EXPECT_EQ(at(in(name + "/a.vdb"), 3), "no place") << name;
    }
    // In the folder of a frame as well.
    std::filesystem::create_directories(folder / "f.03/take@1");
    EXPECT_EQ(at(in("f.##/take@1/a.vdb"), 3), in("f.03/take@1/a.vdb"));
    EXPECT_EQ(at(in("f.##/take@1/a.vdb"), 4), in("f.04/take41/a.vdb"));
}

TEST(FrameName, TellsOfFolders) {
    const test::TempFolder folder;
    std::filesystem::create_directory(folder / "is@there");
    const auto folderOf = [](const std::string& name) { return FrameName::find(name)->folder(); };
    EXPECT_EQ(folderOf("a/b.##.vdb"), "");
    EXPECT_EQ(folderOf("a/b@c/d#e/b.##.vdb"), "a/b@c");
    EXPECT_EQ(folderOf((folder / "is@there/b.##.vdb").string()), "");
}

TEST(FrameName, TakesWhatIsEscapedAsItIs) {
    EXPECT_EQ(at("a\\@b.##.vdb", 3), "a@b.03.vdb");
    EXPECT_EQ(at("a\\@b/\\#\\%04d\\$F.%d\\\\.vdb", 3), "a@b/#%04d$F.3\\.vdb");
    EXPECT_EQ(at("a\\@b.vdb", 3), "no place");
    EXPECT_EQ(at("a\\b.@.vdb", 3), "a\\b.3.vdb");
}

// A file that is there is no sequence.
TEST(FrameName, LeavesInputsThatAreThereAlone) {
    const test::TempFolder folder;
    const std::string name = (folder / "a@b.#.vdb").string();
    EXPECT_TRUE(FrameName::findInput(name));
    std::ofstream(name) << "a";
    EXPECT_FALSE(FrameName::findInput(name));
    EXPECT_TRUE(FrameName::find(name));
}

TEST(FrameName, LeavesOthersAlone) {
    for (const char* name : {"a.vdb", "a.0001.vdb", "50%.vdb", "a%4d.vdb", "a%.vdb", "$FF.vdb",
                             "$F_x.vdb", "$f4.vdb", "a$4.vdb", "%04", "%040d.vdb"})
        EXPECT_EQ(at(name, 1), "no place") << name;
    EXPECT_EQ(at(std::string(33, '#') + ".vdb", 1), "no place");
}

// Slices of a stack are no frames.
TEST(FrameName, CountsNoSlices) {
    const auto input = [](const std::string& name) {
        const std::optional<FrameName> found = FrameName::findInput(name);
        return found ? found->at(3).string() : "no place";
    };
    EXPECT_EQ(input("slice.####.png"), "no place");
    EXPECT_EQ(input("slice.%04d.tif"), "no place");
    EXPECT_EQ(input("frame.##/slice.####.png"), "frame.03/slice.####.png");
    EXPECT_EQ(input("f$F2.slice.####.png"), "f03.slice.####.png");
    EXPECT_EQ(input("smoke.####.vdb"), "smoke.0003.vdb");
    EXPECT_EQ(at("picture.####.png", 3), "picture.0003.png");
    // Who looks for slices knows escapes, too.
    EXPECT_EQ(input("f\\@1.@/a\\#.$F.####.png"), "f@1.3/a\\#.3.####.png");
    EXPECT_EQ(input("a\\#.$F.png"), "a#.3.png");
}

}  // namespace
}  // namespace deltasplat
