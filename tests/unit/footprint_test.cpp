// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/splat/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

const glm::dvec2 kShifts[] = {{0, 0}, {0.6, -0.75}, {1, 1}, {-1, 0.2}};

TEST(Footprint, WeightsOfEveryPhaseAddUpToOne) {
    for (const double sigma : {0.2, 0.4, 1.0, 4.0}) {
        for (const glm::dvec2 shift : kShifts) {
            for (const int r : {1, 2, 3, 8}) {
                const Footprint footprint = makeFootprint(sigma, shift, r);
                std::vector<std::int64_t> sums(std::size_t(r) * r);
                for (int v = 0; v < footprint.width; ++v) {
                    for (int u = 0; u < footprint.width; ++u) {
                        EXPECT_GE(footprint.at(u, v), 0);
                        sums[(v % r) * r + u % r] += footprint.at(u, v);
                    }
                }
                for (const std::int64_t sum : sums) EXPECT_EQ(sum, Footprint::kOne);
            }
        }
    }
}

// Second moments of the table, in voxels, against the covariance sigma^2 (I + d d^T).
TEST(Footprint, HasTheCovarianceOfTheRoundKernelSeenAlongTheView) {
    const double sigma = 1.3;
    const int r = 4;
    for (const glm::dvec2 d : kShifts) {
        const Footprint footprint = makeFootprint(sigma, d, r);
        const double middle = 0.5 * (footprint.width - 1);
        double sum = 0;
        double uu = 0;
        double uv = 0;
        double vv = 0;
        for (int y = 0; y < footprint.width; ++y) {
            for (int x = 0; x < footprint.width; ++x) {
                const double u = (x - middle) / r;
                const double v = (y - middle) / r;
                const double w = footprint.at(x, y);
                sum += w;
                uu += w * u * u;
                uv += w * u * v;
                vv += w * v * v;
            }
        }
        // What lies beyond the cut-off is missing: a few percent of the second moment.
        EXPECT_NEAR(uu / sum, sigma * sigma * (1 + d.x * d.x), 0.06 * sigma * sigma * 2);
        EXPECT_NEAR(vv / sum, sigma * sigma * (1 + d.y * d.y), 0.06 * sigma * sigma * 2);
        EXPECT_NEAR(uv / sum, sigma * sigma * d.x * d.y, 0.06 * sigma * sigma * 2);
    }
}

TEST(Footprint, IsSymmetricAboutItsMiddle) {
    const Footprint footprint = makeFootprint(0.7, {0.5, -0.3}, 2);
    const int last = footprint.width - 1;
    for (int v = 0; v <= last; ++v) {
        for (int u = 0; u <= last; ++u) {
            // Rounding by the largest remainder may favour one of two equal weights by one.
            EXPECT_NEAR(footprint.at(u, v), footprint.at(last - u, last - v), 1);
        }
    }
}

TEST(Footprint, NarrowKernelIsThreePixelsWide) {
    EXPECT_EQ(makeFootprint(0.4, {0, 0}, 1).width, 3);
    EXPECT_EQ(makeFootprint(0.4, {0.6, 0.75}, 1).width, 3);
}

TEST(Footprint, TakesAnyWidthThatReachesEveryPhase) {
    for (const int width : {1, 2, 6, 7}) {
        const Footprint footprint = makeFootprint(1, {0, 0}, 1, width);
        EXPECT_EQ(footprint.width, width);
        EXPECT_EQ(footprint.reach(), width / 2);
        EXPECT_EQ(footprint.offsetPixels(), width % 2 == 0 ? 0.5 : 0);
        EXPECT_EQ(std::accumulate(footprint.weights.begin(), footprint.weights.end(), 0),
                  Footprint::kOne);
        // Its largest weights lie around the middle.
        // Rounding may favour one of equal weights by one.
        EXPECT_GE(footprint.at(width / 2, width / 2) + 1,
                  *std::max_element(footprint.weights.begin(), footprint.weights.end()));
    }
    EXPECT_THROW(makeFootprint(1, {0, 0}, 2, 1), Error);
    EXPECT_THROW(makeFootprint(1, {0, 0}, 1, 0), Error);
    EXPECT_THROW(makeFootprint(1, {0, 0}, 1, kMaxFootprintWidth + 1), Error);
}

TEST(Footprint, RefusesSigmaOutOfRange) {
    for (const double sigma : {0.1, 4.1, -1.0, std::nan("")}) {
        try {
            makeFootprint(sigma, {0, 0}, 1);
            FAIL() << sigma;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
            EXPECT_NE(std::string(error.what()).find("expected a number of voxels from 0.2 to 4"),
                      std::string::npos);
        }
    }
}

}  // namespace
}  // namespace deltasplat
