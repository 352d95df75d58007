// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_list.h"

#include <gtest/gtest.h>

#include "deltasplat/error.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

std::vector<int> framesOf(const std::string& text) {
    return frameList()("--frames", text);
}

using Frames = std::vector<int>;

TEST(FrameList, NamesFramesInTheirOrder) {
    EXPECT_EQ(framesOf("7"), (Frames{7}));
    EXPECT_EQ(framesOf("1-4"), (Frames{1, 2, 3, 4}));
    EXPECT_EQ(framesOf("4-1"), (Frames{4, 3, 2, 1}));
    EXPECT_EQ(framesOf("1-10x4"), (Frames{1, 5, 9}));
    EXPECT_EQ(framesOf("10-1x4"), (Frames{10, 6, 2}));
    EXPECT_EQ(framesOf("1,4,10-12"), (Frames{1, 4, 10, 11, 12}));
    EXPECT_EQ(framesOf("0007"), (Frames{7}));
}

TEST(FrameList, KnowsNegativeNumbers) {
    EXPECT_EQ(framesOf("-5"), (Frames{-5}));
    EXPECT_EQ(framesOf("-2-1"), (Frames{-2, -1, 0, 1}));
    EXPECT_EQ(framesOf("-3--5"), (Frames{-3, -4, -5}));
    EXPECT_EQ(framesOf("1--3x2"), (Frames{1, -1, -3}));
}

TEST(FrameList, NamesEachOnce) {
    EXPECT_EQ(framesOf("1-3,2,5,3-6"), (Frames{1, 2, 3, 5, 4, 6}));
}

TEST(FrameList, RefusesWhatIsNone) {
    for (const char* text : {"", "1-", "-", "a", "1-5x", "1-5x0", "1-5x-1", "1,,2", "1-2-3", "1 2",
                             "1.5", "99999999999", "1-5x2x2"}) {
        EXPECT_NE(test::errorOf([&] {
                      framesOf(text);
                  }).find(std::string("--frames: got ") + text + "; expected frames such as"),
                  std::string::npos)
            << text;
    }
    EXPECT_EQ(framesOf("1-1000000").size(), kMostFrames);
    EXPECT_NE(test::errorOf([&] { framesOf("0-1000000"); }).find("at most 1000000 frames"),
              std::string::npos);
    EXPECT_NE(test::errorOf([&] { framesOf("-2147483648-2147483647"); }).find("at most"),
              std::string::npos);
}

}  // namespace
}  // namespace deltasplat
