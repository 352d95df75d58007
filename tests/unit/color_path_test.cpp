// SPDX-License-Identifier: Apache-2.0
#include "optics/color_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "deltasplat/optics/transfer_function.h"
#include "image/srgb.h"
#include "optics/color_space.h"

namespace deltasplat {
namespace {

glm::dvec3 labOf(const glm::dvec3& rgb) {
    return labFromLinear({linearFromSrgb(rgb.r), linearFromSrgb(rgb.g), linearFromSrgb(rgb.b)});
}

double lengthOf(const std::vector<ColorPaths::Stop>& stops) {
    double length = 0;
    for (std::size_t i = 1; i < stops.size(); ++i)
        length += colorDifference(labOf(stops[i - 1].rgb), labOf(stops[i].rgb));
    return length;
}

// Of the pairs that Sharma, Wu and Dalal published with the formula.
TEST(ColorDifference, IsAsPublished) {
    struct Pair {
        glm::dvec3 a, b;
        double difference;
    };
    for (const Pair& pair :
         {Pair{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
          Pair{{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
          Pair{{50, 0, 0}, {50, -1, 2}, 2.3669},
          Pair{{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
          Pair{{50, 2.5, 0}, {73, 25, -18}, 27.1492},
          Pair{{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
          Pair{{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
          Pair{{22.7233, 20.0904, -46.694}, {23.0331, 14.973, -42.5619}, 2.0373},
          Pair{{2.0776, 0.0795, -1.135}, {0.9033, -0.0636, -0.5514}, 0.9082}}) {
        EXPECT_NEAR(colorDifference(pair.a, pair.b), pair.difference, 5.1e-5);
        EXPECT_NEAR(colorDifference(pair.b, pair.a), pair.difference, 5.1e-5);
    }
    EXPECT_EQ(colorDifference({50, 10, 20}, {50, 10, 20}), 0);
}

// Lengths of shortest ways to a point of the grid, by going over all steps until nothing changes.
std::vector<double> plainLengths(int to) {
    std::vector<glm::dvec3> lab;
    for (int i = 0; i < 4913; ++i)
        lab.push_back(labOf(glm::dvec3(i / 289, i / 17 % 17, i % 17) / 16.0));
    std::vector<double> lengths(4913, std::numeric_limits<double>::infinity());
    lengths[to] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < 4913; ++i) {
            if (!std::isfinite(lengths[i])) continue;
            for (int k = 0; k < 27; ++k) {
                const int r = i / 289 + k / 9 - 1;
                const int g = i / 17 % 17 + k / 3 % 3 - 1;
                const int b = i % 17 + k % 3 - 1;
                if (std::min({r, g, b}) < 0 || std::max({r, g, b}) > 16) continue;
                const int other = (r * 17 + g) * 17 + b;
                const double there = lengths[i] + colorDifference(lab[i], lab[other]);
                if (there < lengths[other] - 1e-9) {
                    lengths[other] = there;
                    changed = true;
                }
            }
        }
    }
    return lengths;
}

TEST(ColorPaths, AreShortest) {
    const glm::dvec3 red(1, 0, 0);
    const std::vector<double> lengths = plainLengths(16 * 289);
    ColorPaths paths;
    for (const glm::ivec3 p : {glm::ivec3(0, 0, 16), glm::ivec3(0, 16, 0), glm::ivec3(16, 16, 16),
                               glm::ivec3(3, 9, 14), glm::ivec3(15, 0, 0)}) {
        const auto stops = paths.between(glm::dvec3(p) / 16.0, red);
        EXPECT_NEAR(lengthOf(stops), lengths[(p.x * 17 + p.y) * 17 + p.z], 1e-6);
        for (std::size_t i = 1; i < stops.size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_LE(std::abs(stops[i].rgb[c] - stops[i - 1].rgb[c]), 1.0 / 16);
    }
}

TEST(ColorPaths, HaveTheirColoursAtTheEndsAndEvenSteps) {
    ColorPaths paths;
    const glm::dvec3 from(0.231, 0.298, 0.752);
    const glm::dvec3 to(0.706, 0.016, 0.15);
    const auto stops = paths.between(from, to);
    EXPECT_EQ(stops.front().rgb, from);
    EXPECT_EQ(stops.back().rgb, to);
    EXPECT_EQ(stops.front().share, 0);
    EXPECT_EQ(stops.back().share, 1);
    const double length = lengthOf(stops);
    for (std::size_t i = 1; i < stops.size(); ++i) {
        const double step = colorDifference(labOf(stops[i - 1].rgb), labOf(stops[i].rgb));
        EXPECT_NEAR(stops[i].share - stops[i - 1].share, step / length, 1e-12);
    }
    // One point of the grid, and none.
    EXPECT_EQ(paths.between({0.5, 0.5, 0.5}, {0.51, 0.5, 0.5}).size(), 2u);
    EXPECT_EQ(paths.between(from, from).back().share, 1);
}

}  // namespace
}  // namespace deltasplat
