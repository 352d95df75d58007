// SPDX-License-Identifier: Apache-2.0
#include "render/value_window.h"

#include <gtest/gtest.h>

namespace deltasplat {
namespace {

// The grey of a picture of this value alone, and the window that it was given.
std::pair<float, glm::dvec2> greyOf(float value) {
    Image image;
    image.size = {2, 1};
    image.rgba = {value, 0, 0, 1, value, 0, 0, 1};
    const glm::dvec2 window = defaultWindow(Mode::kMip, middleValues(Mode::kMip, image));
    showGreys(window, image);
    return {image.rgba[4], window};
}

TEST(ValueWindow, OneValueIsWhiteOnlyAboveNothing) {
    EXPECT_EQ(greyOf(3).first, 1);
    EXPECT_EQ(greyOf(0).first, 0);
    for (const float value : {-1e-30f, -5.0f, -1000.0f, -1e30f}) {
        const auto [grey, window] = greyOf(value);
        EXPECT_EQ(grey, 0) << value;
        EXPECT_LT(window.x, window.y) << value;
    }
}

}  // namespace
}  // namespace deltasplat
