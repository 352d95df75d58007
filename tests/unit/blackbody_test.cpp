// SPDX-License-Identifier: Apache-2.0
#include "optics/color_space.h"

#include <gtest/gtest.h>

#include <cmath>

namespace deltasplat {
namespace {

// From tables of the Planckian locus for the CIE 1931 observer (G. Wyszecki, W. Stiles, Color
// Science, 1982), and illuminant A (CIE 15).
TEST(Blackbody, hasThePublishedColors) {
    struct Known {
        double kelvin, x, y;
    };
    for (const Known& known :
         {Known{1000, 0.6528, 0.3444}, Known{1500, 0.5857, 0.3931}, Known{2000, 0.5267, 0.4133},
          Known{2500, 0.4770, 0.4137}, Known{2856, 0.4476, 0.4074}, Known{4000, 0.3805, 0.3768},
          Known{6500, 0.3135, 0.3237}, Known{10000, 0.2807, 0.2884}}) {
        const glm::dvec2 xy = blackbodyChromaticity(known.kelvin);
        EXPECT_NEAR(xy.x, known.x, 7e-4) << known.kelvin;
        EXPECT_NEAR(xy.y, known.y, 7e-4) << known.kelvin;
    }
}

TEST(Blackbody, colorsHaveLuminance1) {
    for (double kelvin = 200; kelvin < 40000; kelvin *= 1.1) {
        const glm::dvec3 color = blackbodyColor(kelvin);
        EXPECT_NEAR(0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b, 1, 1e-12);
        for (int c = 0; c < 3; ++c) EXPECT_GE(color[c], 0);
    }
    EXPECT_GT(blackbodyColor(1000).r, 20 * blackbodyColor(1000).g);
    EXPECT_EQ(blackbodyColor(1000).b, 0);
    EXPECT_GT(blackbodyColor(12000).b, blackbodyColor(12000).r);
}

// Stefan and Boltzmann's law, from where things are seen to glow.
TEST(Blackbody, glowsWithTheFourthPower) {
    const auto luminance = [](double kelvin) {
        const glm::dvec3 glow = blackbodyGlow(kelvin);
        return 0.2126 * glow.r + 0.7152 * glow.g + 0.0722 * glow.b;
    };
    EXPECT_NEAR(luminance(1500), 0.09137, 2e-5);
    EXPECT_NEAR(luminance(3000) / luminance(1500), 16, 1e-9);
    EXPECT_EQ(luminance(500), 0);
    EXPECT_EQ(luminance(0), 0);
    EXPECT_EQ(luminance(-273), 0);
    EXPECT_EQ(luminance(std::nan("")), 0);
    for (double kelvin = 501; kelvin < 900; ++kelvin)
        EXPECT_GT(luminance(kelvin), luminance(kelvin - 1));
}

}  // namespace
}  // namespace deltasplat
