// SPDX-License-Identifier: Apache-2.0
#include "splat/tile_kernels.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/simd.h"

namespace deltasplat {
namespace {

constexpr int kWidth = 56;  // pixels of plane and sheet
constexpr int kHeight = 24;
constexpr int kFirst = 8;  // the first pixel of the tiles

class TilesOnEveryLevel : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { setSimdLevel(GetParam()); }
    void TearDown() override { setSimdLevel("auto"); }
};

INSTANTIATE_TEST_SUITE_P(Simd, TilesOnEveryLevel, testing::ValuesIn(simdLevels()),
                         [](const auto& level) { return level.param; });

// A plane of random colours, of which a share is zero, and what its stamps add up to.
struct Scene {
    Scene(const Footprint& footprint, int channelCount, double empty, std::uint32_t seed)
        : channels(channelCount), plane(channels * kWidth * kHeight), sums(plane.size()) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> color(0, ClassTable::kMax);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (int y = 1; y + 1 < kHeight; ++y) {
            for (int x = 1; x + 1 < kWidth; ++x) {
                if (uniform(random) < empty) continue;
                for (int c = 0; c < channels; ++c) stamp(footprint, x, y, c, color(random));
            }
        }
    }

    void stamp(const Footprint& footprint, int x, int y, int c, int color) {
        plane[channels * (y * kWidth + x) + c] = std::int16_t(color);
        for (int j = 0; j < footprint.width; ++j) {
            for (int i = 0; i < footprint.width; ++i) {
                const int column = x + i - footprint.reach();
                const int row = y + j - footprint.reach();
                sums[channels * (row * kWidth + column) + c] += color * footprint.at(i, j);
            }
        }
    }

    int channels;
    std::vector<std::int16_t> plane;
    std::vector<std::int32_t> sums;
};

TEST_P(TilesOnEveryLevel, TouchedRowsAreTheSumsOfStamps) {
    const std::vector<std::uint8_t> touched = {0xFF, 0x01, 0, 0x80, 0x18};
    std::uint32_t seed = 0;
    for (const double sigma : {0.2, 0.3, 0.5}) {
        for (const glm::dvec2 d : {glm::dvec2(0), glm::dvec2(0.8, -0.6)}) {
            const Footprint footprint = makeFootprint(sigma, d, 1, sigma == 0.2 ? 1 : 3);
            ASSERT_TRUE(TileWeights::fits(footprint));
            for (const int channels : {1, 4}) {
                for (const double empty : {0.0, 0.97}) {
                    const Scene scene(footprint, channels, empty, ++seed);
                    std::vector<std::int32_t> sheet(scene.sums.size(), -7);
                    std::vector<std::uint8_t> full(touched.size(), 0xFF);
                    const std::size_t pitch = channels * kWidth;
                    const std::size_t first = kFirst * pitch + channels * kFirst;
                    splatTiles(TileWeights(footprint, channels),
                               {&scene.plane[first], pitch, &sheet[first], pitch}, touched, full);
                    for (int row = 0; row < kHeight * int(touched.size()); ++row) {
                        const int tile = row / kHeight;
                        const int y = row % kHeight - kFirst;
                        const bool inTile = y >= 0 && y < 8;
                        const bool made = inTile && (touched[tile] >> y & 1);
                        bool any = false;
                        for (int i = 0; i < 8 * channels; ++i) {
                            const std::size_t place =
                                (y + kFirst) * pitch + channels * (kFirst + 8 * tile) + i;
                            ASSERT_EQ(sheet[place], made ? scene.sums[place] : -7);
                            any = any || scene.sums[place] != 0;
                        }
                        if (!inTile) continue;
                        EXPECT_EQ(full[tile] >> y & 1, made ? any : 1);
                    }
                }
            }
        }
    }
}

TEST(TileWeights, FitSmallFootprintsAtOnePixelAVoxel) {
    EXPECT_TRUE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 3)));
    EXPECT_TRUE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 1)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 2)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 5)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 2, 3)));
}

}  // namespace
}  // namespace deltasplat
