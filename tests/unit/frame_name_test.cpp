// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_name.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

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

TEST(FrameName, FillsFoldersAsWell) {
    EXPECT_EQ(at("shot.##/a.####.vdb", 3), "shot.03/a.0003.vdb");
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
}

}  // namespace
}  // namespace deltasplat
