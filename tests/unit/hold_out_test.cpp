// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/hold_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "deltasplat/image/write_image.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

// Two pixels: fog that takes half from 2 to 4 and half of the rest from 4 to 8, and glow alone.
DeepImage someDeep() {
    DeepImage deep;
    deep.size = {2, 1};
    deep.rows.resize(1);
    deep.rows[0].samples = {
        {{0.5f, 0.25f, 0, 0.5f}, 2, 4}, {{0, 0.25f, 0.5f, 0.5f}, 4, 8}, {{4, 2, 0, 0}, 1, 3}};
    deep.rows[0].begins = {0, 2, 3};
    return deep;
}

glm::vec4 seenAt(float depth, int pixel) {
    const Image image = holdOut(someDeep(), {{2, 1}, {depth, depth}});
    const float* rgba = image.pixel(pixel, 0);
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

TEST(HoldOut, leavesWhatIsBefore) {
    const float everywhere = std::numeric_limits<float>::infinity();
    EXPECT_EQ(seenAt(everywhere, 0), glm::vec4(0.5f, 0.375f, 0.25f, 0.75f));
    EXPECT_EQ(seenAt(8, 0), glm::vec4(0.5f, 0.375f, 0.25f, 0.75f));
    EXPECT_EQ(seenAt(4, 0), glm::vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(seenAt(2, 0), glm::vec4(0));
    EXPECT_EQ(seenAt(1, 0), glm::vec4(0));
    EXPECT_EQ(seenAt(3, 1), glm::vec4(4, 2, 0, 0));
}

// Fog by what a shorter way absorbs, glow by its length.
TEST(HoldOut, cutsWhatIsInTheWay) {
    const double quarter = 1 - std::pow(0.5, 0.25);
    EXPECT_NEAR(seenAt(2.5f, 0).a, quarter, 1e-6);
    EXPECT_NEAR(seenAt(2.5f, 0).g, 0.5 * quarter, 1e-6);
    EXPECT_NEAR(seenAt(5, 0).a, 0.5 + 0.5 * quarter, 1e-6);
    EXPECT_NEAR(seenAt(1.5f, 1).r, 1, 1e-6);
}

TEST(HoldOut, refusesAnotherSize) {
    EXPECT_EQ(errorOf([] {
                  holdOut(someDeep(), {{1, 2}, {1, 1}});
              }),
              "usage: depths of solid things: got 1x2 pixels; expected 2x1, those of the picture");
}

TEST(HoldOut, readsChannelsOfDepth) {
    const test::TempFolder folder;
    const auto file = folder / "z.exr";
    Image image({3, 1});
    ImageFileOptions options;
    options.channels = {{"P.Z", {7, 7, 7}}, {"ViewLayer.Depth.Z", {1.5f, 1e10f, -2}}};
    writeImage(file, image, options);
    std::string warned;
    Listener listener;
    listener.warning = [&](const std::string& text) { warned += text; };
    const DepthImage read = readDepthImage(file, listener);
    const float nothing = std::numeric_limits<float>::infinity();
    EXPECT_EQ(read.depths, (std::vector<float>{1.5f, nothing, nothing}));
    EXPECT_NE(warned.find("1 pixel whose depth is not above 0 stands"), std::string::npos);
    options.channels.push_back({"depth", {7, 8, 9}});
    writeImage(file, image, options);
    EXPECT_EQ(readDepthImage(file).depths, (std::vector<float>{7, 8, 9}));
    options.channels.push_back({"Z", {4, 5, 6}});
    options.channels.push_back({"Vector.Z", {1, 1, 1}});
    writeImage(file, image, options);
    EXPECT_EQ(readDepthImage(file).depths, (std::vector<float>{4, 5, 6}));
    options.channels.resize(1);
    writeImage(file, image, options);
    EXPECT_NE(errorOf([&] { readDepthImage(file); }).find("expected a channel Z"),
              std::string::npos);
}

}  // namespace
}  // namespace deltasplat
