// SPDX-License-Identifier: Apache-2.0
#include "formats/usd/usd_scene.h"

#include <functional>
#include <random>

#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

const std::string kScene = R"(#usda 1.0
( upAxis = "Z" )
def Xform "World" {
    double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 3: (20, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Volume "smoke" {
        rel field:heat = </World/smoke/heat>
        rel field:density = [ </World/smoke/density> ]
        float3 xformOp:scale = (2, 3, 4)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        def OpenVDBAsset "density" {
            asset filePath.timeSamples = { 1: @./a.1.vdb@, 2: @sub/../a.2.vdb@, 3: None }
            token fieldName = "d"
        }
        def OpenVDBAsset "heat" {
            asset filePath = @./a.1.vdb@
            token fieldName = "h"
        }
    }
}
)";

struct Read {
    UsdVolumeMotion motion;
    std::vector<std::string> warnings;
    std::filesystem::path folder;
};

Read readScene(const std::string& text, const std::string& name = "") {
    const TempFolder folder;
    std::ofstream(folder / "s.usda") << text;
    Read read;
    Listener listener;
    listener.warning = [&](const std::string& line) {
        read.warnings.push_back(line.substr(line.find(".usda")));
    };
    read.motion = readUsdVolume(folder / "s.usda", name, listener);
    read.folder = folder.path();
    return read;
}

std::string said(const std::string& text, const std::string& name = "") {
    try {
        readScene(text, name).motion.at(1);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        const std::string what = error.what();
        return what.substr(what.find(".usda"));
    }
    return "";
}

TEST(UsdVolume, AFieldIsWhereItsVolumeStands) {
    const Read read = readScene(kScene);
    EXPECT_EQ(read.motion.frames, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(read.motion.upWorld, glm::dvec3(0, 0, 1));
    const UsdVolume volume = read.motion.at(2);
    EXPECT_EQ(volume.file, read.folder / "a.2.vdb");
    EXPECT_EQ(volume.grid, "d");
    EXPECT_EQ(volume.worldFromVolume * glm::dvec4(1, 1, 1, 1), glm::dvec4(12, 3, 4, 1));
    // Files are held, not mixed; a blocked one is none.
    EXPECT_EQ(read.motion.at(1.9).file, read.folder / "a.1.vdb");
    EXPECT_EQ(read.motion.at(3).file, "");
    EXPECT_EQ(read.motion.at(0).file, read.folder / "a.1.vdb");
    EXPECT_TRUE(read.warnings.size() <= 1);
}

TEST(UsdVolume, APrimMayBeNamed) {
    EXPECT_EQ(readScene(kScene, "/World/smoke").motion.at(1).grid, "d");
    EXPECT_EQ(readScene(kScene, "/World/smoke/heat").motion.at(1).grid, "h");
    EXPECT_EQ(readScene("#usda 1.0\ndef OpenVDBAsset \"a\" { asset filePath = @b.vdb@ }")
                  .motion.at(1)
                  .grid,
              "");
}

TEST(UsdVolume, WhatIsNotFollowedIsSaid) {
    const Read read = readScene(R"(#usda 1.0
def Volume "v" ( references = @./other.usda@ ) {
    rel field:density = </v/d>
    rel field:heat = </v/h>
    def OpenVDBAsset "d" {
        asset filePath = @a.vdb@
        int fieldIndex = 2
        float3 xformOp:scale = (2, 2, 2)
        uniform token[] xformOpOrder = ["xformOp:scale"]
    }
    def OpenVDBAsset "h" { asset filePath = @b.vdb@ }
})");
    EXPECT_EQ(
        read.warnings,
        (std::vector<std::string>{
            ".usda: /v: references are not followed", ".usda: /v/d: fieldIndex is not followed",
            ".usda: /v/d: its xformOps are left out, for a Volume's place is its own",
            ".usda: /v/h of another file is left out"}));
    EXPECT_EQ(read.motion.at(0).worldFromVolume, glm::dmat4(1));
}

TEST(UsdVolume, WhatIsWrongIsSaid) {
    const auto volume = [](const std::string& field, const std::string& asset) {
        return "#usda 1.0\ndef Volume \"v\" {\n" + field + "\ndef OpenVDBAsset \"d\" {\n" + asset +
               "\n} }";
    };
    const std::string field = "rel field:density = </v/d>";
    const struct {
        std::string text;
        const char* said;
    } cases[] = {
        {"#usda 1.0\n", ".usda: got no prim of type OpenVDBAsset; expected at least one"},
        {volume("", ""),
         ".usda:2: got a Volume without fields; expected rel field:density, or another one"},
        {volume("rel field:density = </v/e>", ""),
         ".usda:3: got </v/e>, which is not there; expected a prim"},
        {volume("rel field:density = </v>", ""), ".usda:2: got a Volume; expected an OpenVDBAsset"},
        {volume(field, "asset filePath = \"a.vdb\""),
         ".usda:5: got \"a.vdb\" for filePath; expected @FILE.vdb@"},
        {volume(field, "asset filePath = @@"), ".usda:5: got @@ for filePath; expected @FILE.vdb@"},
        {volume(field, "asset filePath = @/etc/passwd@"),
         ".usda:5: got @/etc/passwd@ for filePath; expected a .vdb"},
        {volume(field + "\nfloat3 xformOp:scale = (1, 0, 1)\nuniform token[] xformOpOrder = "
                        "[\"xformOp:scale\"]",
                "asset filePath = @a.vdb@"),
         ".usda: /v: got a transform that cannot be inverted; expected finite numbers that give "
         "each voxel a place of its own"},
    };
    for (const auto& one : cases) EXPECT_EQ(said(one.text), one.said) << one.text;
    EXPECT_EQ(said(kScene, "/World/fire"),
              ".usda: got no prim of type Volume at /World/fire; expected one of /World/smoke");
}

std::string sceneWith(const std::string& statements) {
    return "#usda 1.0\ndef Volume \"v\"\n{\n rel field:density = </v/d>\n" + statements +
           " def OpenVDBAsset \"d\"\n {\n asset filePath = @a.vdb@\n }\n}\n";
}

std::string repeated(int count, const std::function<std::string(int)>& statement) {
    std::string text;
    for (int i = 0; i < count; ++i) text += statement(i);
    return text;
}

// A hundred thousand of anything takes as long as reading it: the square of it would be hours.
TEST(UsdVolume, NothingGrowsWithTheSquareOfWhatAFileHas) {
    const auto expectRead = [](const std::string& statements) {
        const Read read = readScene(sceneWith(statements));
        EXPECT_EQ(read.motion.at(0).file.filename(), "a.vdb");
    };
    constexpr int kMany = 200000;
    expectRead(repeated(kMany, [](int i) { return " int a" + std::to_string(i) + " = 1\n"; }));
    expectRead(repeated(
        kMany, [](int i) { return " float a.timeSamples = {" + std::to_string(i) + ": 1}\n"; }));
    expectRead(repeated(kMany, [](int) { return " float a.timeSamples = {5: 1}\n"; }));
    expectRead(" float a.timeSamples = {" + repeated(kMany, [](int) { return "5: 1, "; }) + "}\n");
    // All on one line.
    expectRead(repeated(kMany, [](int i) { return " asset a" + std::to_string(i) + " = @b@;"; }));
    expectRead(repeated(kMany / 4, [](int i) {
        const std::string name = "b" + std::to_string(i);
        return " rel field:" + name + " = </v/" + name + ">\n def OpenVDBAsset \"" + name +
               "\" { asset filePath = @a.vdb@ }\n";
    }));
}

TEST(UsdVolume, WhatWouldBeFollowedForHoursIsRefused) {
    const auto scene = [](int ops) {
        return sceneWith(
            " double3 xformOp:translate = (1, 0, 0)\n uniform token[] xformOpOrder = [" +
            repeated(ops, [](int) { return "\"xformOp:translate\", "; }) + "]\n");
    };
    EXPECT_EQ(readScene(scene(256)).motion.at(0).worldFromVolume[3].x, 256);
    for (const int ops : {257, 5000}) {
        EXPECT_EQ(said(scene(ops)),
                  ".usda:6: got an xformOpOrder of more than 256 ops; expected at most 256");
    }
}

TEST(UsdVolume, SpoiltScenesAreReadOrRefused) {
    std::mt19937 random(7);
    const std::string some = "(){}[]<>@\"'=:,;.#!0179-+eEnN \n\\/";
    for (int round = 0; round < 300; ++round) {
        std::string text = kScene;
        for (int i = 0; i < 3; ++i)
            text[10 + random() % (text.size() - 10)] = some[random() % some.size()];
        said(text);
    }
}

}  // namespace
}  // namespace deltasplat::test
