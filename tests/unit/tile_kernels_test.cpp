// SPDX-License-Identifier: Apache-2.0
#include "splat/tile_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/simd.h"
#include "splat/cell_kernels.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

constexpr int kWidth = 72;  // pixels of the sheet
constexpr int kHeight = 40;
constexpr int kFirst = 16;  // the first pixel of the tiles

class TilesOnEveryLevel : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { setSimdLevel(GetParam()); }
    void TearDown() override { setSimdLevel("auto"); }
};

INSTANTIATE_TEST_SUITE_P(Simd, TilesOnEveryLevel, testing::ValuesIn(test::testedSimdLevels()),
                         [](const auto& level) { return level.param; });

// A plane of random colours, of which a share is zero, and what its stamps add up to.
struct Scene {
    Scene(const Footprint& footprint, int channelCount, double empty, std::uint32_t seed)
        : channels(channelCount),
          width(kWidth / footprint.resolution),
          height(kHeight / footprint.resolution),
          plane(channels * width * height),
          sums(channels * kWidth * kHeight) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> color(0, ClassTable::kMax);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (int y = 1; y + 1 < height; ++y) {
            for (int x = 1; x + 1 < width; ++x) {
                if (uniform(random) < empty) continue;
                for (int c = 0; c < channels; ++c) stamp(footprint, x, y, c, color(random));
            }
        }
    }

    void stamp(const Footprint& footprint, int x, int y, int c, int color) {
        plane[channels * (y * width + x) + c] = std::int16_t(color);
        for (int j = 0; j < footprint.width; ++j) {
            for (int i = 0; i < footprint.width; ++i) {
                const int column = footprint.resolution * x + i - footprint.reach();
                const int row = footprint.resolution * y + j - footprint.reach();
                if (column < 0 || column >= kWidth || row < 0 || row >= kHeight) continue;
                sums[channels * (row * kWidth + column) + c] += color * footprint.at(i, j);
            }
        }
    }

    // As PairedRow has it.
    std::vector<std::int16_t> paired() const {
        const std::size_t pitch = std::size_t(channels * width);
        std::vector<std::int16_t> pairs(plane.size());
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const std::size_t row = i / pitch;
            pairs[(row / 2 * pitch + i % pitch) * 2 + row % 2] = plane[i];
        }
        return pairs;
    }

    int channels;
    int width;  // of the plane
    int height;
    std::vector<std::int16_t> plane;
    std::vector<std::int32_t> sums;
};

// Where the tiles begin in such pairs.
PairedRow firstTileOf(const Scene& scene, const std::vector<std::int16_t>& pairs) {
    const std::size_t voxel = std::size_t(kFirst * scene.width / kWidth);
    const std::size_t pitch = std::size_t(scene.channels * scene.width);
    return {&pairs[voxel * (pitch + 2 * std::size_t(scene.channels))], 2 * pitch};
}

constexpr int kTiles = 6;
const std::vector<std::uint8_t> kTouched = {0xFF, 0x01, 0, 0x80, 0x18, 0x7E, 0, 0};

// Compares every pixel of the tiles and around them, and what is said to be full.
void expectSums(const Scene& scene, const std::vector<std::int32_t>& sheet,
                const std::vector<std::uint8_t>& full) {
    for (int y = 0; y < kHeight; ++y) {
        for (int tile = 0; tile < kTiles; ++tile) {
            const int row = y - kFirst;
            const bool inTile = row >= 0 && row < 8;
            const bool made = inTile && (kTouched[tile] >> row & 1);
            bool any = false;
            for (int i = 0; i < 8 * scene.channels; ++i) {
                const std::size_t place = scene.channels * (y * kWidth + kFirst + 8 * tile) + i;
                ASSERT_EQ(sheet[place], made ? scene.sums[place] : -7) << y << ' ' << tile;
                any = any || scene.sums[place] != 0;
            }
            if (inTile) {
                EXPECT_EQ(full[tile] >> row & 1, made ? any : 1);
            }
        }
    }
}

// Compares what `splat(channels, scene, row, full)` makes with stamps, of full and nearly empty
// planes of one channel and four.
template <typename Splat>
void expectSumsOfStamps(const Footprint& footprint, std::uint32_t& seed, const Splat& splat) {
    for (const int channels : {1, 4}) {
        for (const double empty : {0.0, 0.97}) {
            const Scene scene(footprint, channels, empty, ++seed);
            std::vector<std::int32_t> sheet(scene.sums.size(), -7);
            std::vector<std::uint8_t> full(kTouched.size(), 0xFF);
            const std::size_t pitch = channels * kWidth;
            splat(channels, scene, TileRow{&sheet[kFirst * (pitch + channels)], pitch}, full);
            expectSums(scene, sheet, full);
        }
    }
}

const glm::dvec2 kShifts[] = {{0, 0}, {0.8, -0.6}};

TEST_P(TilesOnEveryLevel, TouchedRowsAreTheSumsOfStamps) {
    std::uint32_t seed = 0;
    for (const int resolution : {1, 2}) {
        for (int width = 2 * resolution - 1; width <= 2 * resolution + 1; width += 2) {
            for (const glm::dvec2 d : kShifts) {
                const Footprint footprint = makeFootprint(0.4, d, resolution, width);
                ASSERT_TRUE(TileWeights::fits(footprint));
                expectSumsOfStamps(footprint, seed,
                                   [&](int channels, const Scene& scene, const TileRow& row,
                                       std::vector<std::uint8_t>& full) {
                                       const std::vector<std::int16_t> pairs = scene.paired();
                                       splatTiles(TileWeights(footprint, channels),
                                                  firstTileOf(scene, pairs), {}, row, kTouched,
                                                  full);
                                   });
            }
        }
    }
}

// Rows that may have a low digit get it, and it is said which do have one.
TEST_P(TilesOnEveryLevel, LowDigitsAreAddedWhereTheyMayBe) {
    // Of touched rows some, and others.
    const std::vector<std::uint8_t> marked = {0x3F, 0x01, 0xFF, 0xFF, 0xF8, 0x5B, 0, 0};
    std::uint32_t seed = 100;
    for (const int resolution : {1, 2}) {
        const Footprint footprint = makeFootprint(0.4, {0.8, -0.6}, resolution, 2 * resolution + 1);
        for (const int channels : {1, 4}) {
            for (const double empty : {0.0, 0.97, 1.0}) {
                Scene scene(footprint, channels, 0.9, ++seed);
                const Scene low(footprint, channels, empty, ++seed);
                const std::size_t pitch = std::size_t(channels * kWidth);
                std::vector<std::uint8_t> expected = marked;
                for (std::size_t i = 0; i < scene.sums.size(); ++i) {
                    const int y = int(i / pitch) - kFirst;
                    const int tile = (int(i % pitch) / channels - kFirst) / 8;
                    if (y < 0 || y >= 8 || tile < 0 || tile >= kTiles) continue;
                    const unsigned row = 1u << y;
                    if ((marked[std::size_t(tile)] & kTouched[std::size_t(tile)] & row) == 0)
                        continue;
                    scene.sums[i] += (low.sums[i] + (1 << 14)) >> 15;
                }
                for (int tile = 0; tile < kTiles; ++tile) {
                    for (int y = 0; y < 8; ++y) {
                        if ((kTouched[std::size_t(tile)] >> y & 1) == 0) continue;
                        const auto first = low.sums.begin() + (kFirst + y) * std::ptrdiff_t(pitch) +
                                           channels * (kFirst + 8 * tile);
                        const bool any = std::any_of(first, first + 8 * channels,
                                                     [](std::int32_t sum) { return sum != 0; });
                        if (!any) expected[std::size_t(tile)] &= std::uint8_t(~(1u << y));
                    }
                }
                std::vector<std::int32_t> sheet(scene.sums.size(), -7);
                std::vector<std::uint8_t> full(kTouched.size(), 0xFF);
                std::vector<std::uint8_t> rows = marked;
                const std::vector<std::int16_t> pairs = scene.paired();
                const std::vector<std::int16_t> lowPairs = low.paired();
                splatTiles(TileWeights(footprint, channels), firstTileOf(scene, pairs),
                           {firstTileOf(low, lowPairs), rows},
                           {&sheet[kFirst * (pitch + channels)], pitch}, kTouched, full);
                expectSums(scene, sheet, full);
                EXPECT_EQ(rows, expected);
            }
        }
    }
}

// The narrowest and the widest footprints that every kernel is for, and some between.
struct WideFootprint {
    int resolution;
    int width;
    int taps;
};
constexpr WideFootprint kWideFootprints[] = {
    {1, 3, 5},  {1, 5, 5},  {1, 7, 7},  {2, 3, 4},  {2, 6, 4},  {2, 7, 4},  {2, 8, 4},  {2, 9, 5},
    {2, 10, 6}, {2, 11, 6}, {2, 12, 6}, {3, 3, 4},  {3, 7, 4},  {3, 10, 4}, {3, 12, 4}, {3, 13, 6},
    {3, 18, 6}, {4, 4, 4},  {4, 9, 4},  {4, 13, 4}, {4, 16, 4}, {4, 17, 6}, {4, 24, 6},
};

TEST_P(TilesOnEveryLevel, TouchedRowsOfCellsAreTheSumsOfStamps) {
    std::uint32_t seed = 100;
    for (const auto& [resolution, width, taps] : kWideFootprints) {
        for (const glm::dvec2 d : kShifts) {
            const Footprint footprint = makeFootprint(0.6, d, resolution, width);
            ASSERT_TRUE(CellWeights::fits(footprint));
            ASSERT_EQ(CellWeights(footprint, 4).taps, taps) << resolution << ' ' << width;
            expectSumsOfStamps(footprint, seed,
                               [&](int channels, const Scene& scene, const TileRow& row,
                                   std::vector<std::uint8_t>& full) {
                                   splatCells(
                                       CellWeights(footprint, channels),
                                       {scene.plane.data(), std::size_t(channels * scene.width),
                                        glm::ivec2(kFirst)},
                                       row, kTouched, full);
                               });
        }
    }
}

// More tiles than are made at a time, with holes between them, in rows that begin anywhere in a
// cell.
TEST_P(TilesOnEveryLevel, CellsOfLongRowsAreTheSumsOfStamps) {
    constexpr int kLong = 48;
    constexpr int kEdge = 20;  // voxels around the one that places are counted from
    std::vector<std::uint8_t> touched(kLong, 0xFF);
    touched[0] = touched[16] = touched[33] = touched[35] = 0;
    touched[20] = 0x24;
    std::mt19937 random(7);
    for (const auto& [resolution, footprintWidth, taps] : kWideFootprints) {
        const Footprint footprint = makeFootprint(0.6, {0.8, -0.6}, resolution, footprintWidth);
        const int width = 8 * kLong / resolution + 2 * kEdge;
        const int height = 2 * kEdge;
        for (const int channels : {1, 4}) {
            const CellWeights weights(footprint, channels);
            std::vector<std::int16_t> plane(std::size_t(channels) * width * height);
            for (std::int16_t& color : plane)
                color = std::int16_t(random() % 3 == 0 ? random() % (ClassTable::kMax + 1) : 0);
            for (const glm::ivec2 first : {glm::ivec2(0), {-8, -8}, {-5, 1}, {2, -7}, {1, 5}}) {
                std::vector<std::int32_t> sheet(std::size_t(channels) * 8 * kLong * 8, -7);
                std::vector<std::uint8_t> full(kLong, 0);
                const std::size_t pitch = std::size_t(channels) * 8 * kLong;
                splatCells(weights,
                           {&plane[std::size_t(channels) * kEdge * (width + 1)],
                            std::size_t(channels) * width, first},
                           {sheet.data(), pitch}, touched, full);
                for (std::size_t i = 0; i < sheet.size(); ++i) {
                    const int c = int(i % channels);
                    const glm::ivec2 p(i % pitch / channels, i / pitch);
                    // Rows between touched ones may be made too.
                    const bool made = touched[p.x / 8] >> p.y & 1;
                    if (!made && touched[p.x / 8] != 0) continue;
                    std::int32_t expected = made ? 0 : -7;
                    for (int n = 0; made && n < footprint.width * footprint.width; ++n) {
                        const glm::ivec2 at(n % footprint.width, n / footprint.width);
                        const glm::ivec2 q = p + first + footprint.reach() - at;
                        if (q.x % resolution != 0 || q.y % resolution != 0) continue;
                        const glm::ivec2 voxel = q / resolution + kEdge;
                        expected += plane[channels * (std::size_t(voxel.y) * width + voxel.x) + c] *
                                    footprint.at(at.x, at.y);
                    }
                    ASSERT_EQ(sheet[i], expected) << p.x << ' ' << p.y << " r " << resolution;
                }
            }
        }
    }
}

TEST_P(TilesOnEveryLevel, LowDigitsAreAddedRounded) {
    std::mt19937 random(3);
    for (const int channels : {1, 4}) {
        const std::size_t pitch = channels * kWidth;
        std::vector<std::int32_t> high(pitch * kTilePixels);
        std::vector<std::int32_t> low(high.size());
        for (std::size_t i = 0; i < high.size(); ++i) {
            if (random() % 4 == 0) high[i] = std::int32_t(random() % (1u << 30));
            if (random() % 2 == 0) low[i] = std::int32_t(random() % (1u << 30));
        }
        // Of the first tile one row is empty, and another holds what is rounded to nothing.
        for (int i = 0; i < 8 * channels; ++i) {
            high[i] = low[i] = 0;
            high[pitch + i] = 0;
            low[pitch + i] = (1 << 14) - 1;
        }
        std::vector<std::int32_t> sheet(high.size(), -7);
        std::vector<std::uint8_t> full(kTouched.size(), 0);
        std::vector<std::uint8_t> rows = kTouched;
        rows[2] = 0x05;
        addLowDigits({high.data(), low.data(), pitch}, channels, rows, sheet.data(), full);
        for (std::size_t i = 0; i < sheet.size(); ++i) {
            const std::size_t tile = i % pitch / (8 * channels);
            const bool made = tile < rows.size() && (rows[tile] >> i / pitch & 1);
            const auto sum = std::int32_t((std::int64_t{high[i]} * 32768 + low[i] + 16384) >> 15);
            ASSERT_EQ(sheet[i], made ? sum : -7) << i;
        }
        EXPECT_EQ(full[0], 0xFC);
        EXPECT_EQ(full[2], 0x05);
    }
}

TEST(CellWeights, FitFootprintsThatReachSevenVoxelsOrSix) {
    const auto fits = [](int resolution, int width) {
        return CellWeights::fits(makeFootprint(0.6, {0, 0}, resolution, width));
    };
    EXPECT_TRUE(fits(1, 7));
    EXPECT_FALSE(fits(1, 6));
    EXPECT_FALSE(fits(1, 9));
    EXPECT_TRUE(fits(2, 12));
    EXPECT_FALSE(fits(2, 13));
    EXPECT_TRUE(fits(3, 9));
    EXPECT_TRUE(fits(3, 12));
    EXPECT_TRUE(fits(3, 18));
    EXPECT_FALSE(fits(3, 19));
    EXPECT_TRUE(fits(4, 16));
    EXPECT_TRUE(fits(4, 24));
    EXPECT_FALSE(fits(4, 25));
    EXPECT_FALSE(fits(5, 5));
}

TEST(TileWeights, FitFootprintsThatReachNoFartherThanTheNextVoxel) {
    EXPECT_TRUE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 3)));
    EXPECT_TRUE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 1)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 2)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 1, 5)));
    EXPECT_TRUE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 2, 5)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 2, 4)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 2, 7)));
    EXPECT_FALSE(TileWeights::fits(makeFootprint(0.3, {0, 0}, 3, 5)));
}

}  // namespace
}  // namespace deltasplat
