// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "deltasplat/simd.h"

namespace deltasplat {
namespace {

class SheetOnEveryLevel : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { setSimdLevel(GetParam()); }
    void TearDown() override { setSimdLevel("auto"); }
};

INSTANTIATE_TEST_SUITE_P(Simd, SheetOnEveryLevel, testing::ValuesIn(simdLevels()),
                         [](const auto& level) { return level.param; });

constexpr IndexBox kBox{{0, -10, 3}, {0, 20, 17}};  // slice, u, v

SheetLayout layoutFor(const Footprint& footprint) {
    return layoutSheet(kBox, footprint);
}

// Adds random stamps to a sheet and to a plain array at once.
struct StampedPair {
    StampedPair(const Footprint& footprint, int stamps, std::uint32_t seed)
        : sheet(layoutFor(footprint)),
          plain(4 * sheet.layout().pitchPixels() * sheet.layout().sizePixels.y) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> color(-65535, 65535);
        std::uniform_int_distribution<int> u(kBox.min.y, kBox.max.y);
        std::uniform_int_distribution<int> v(kBox.min.z, kBox.max.z);
        const StampWeights weights(footprint);
        StampList list;
        for (int i = 0; i < stamps; ++i) {
            const std::size_t place =
                sheet.layout().stampPlace({u(random), v(random)}, footprint.radius);
            list.places[list.count] = std::uint32_t(place);
            for (int c = 0; c < 4; ++c) {
                const int value = color(random);
                list.colors[list.count][c] = value;
                addPlain(footprint, place, c, value);
            }
            if (++list.count == StampList::kCapacity || i + 1 == stamps) {
                addStamps(sheet.pixels(), sheet.layout().pitchPixels(), weights, list);
                EXPECT_EQ(list.count, 0u);
            }
        }
    }

    void addPlain(const Footprint& footprint, std::size_t place, int c, int value) {
        for (int y = 0; y < footprint.width(); ++y) {
            for (int x = 0; x < footprint.width(); ++x) {
                // Unsigned, because sums of random colours may leave the range that real ones keep
                // to.
                plain[4 * (place + y * sheet.layout().pitchPixels() + x) + c] +=
                    std::uint32_t(value) * std::uint32_t(footprint.at(x, y));
            }
        }
    }

    bool equal() const {
        const auto* pixels = reinterpret_cast<const std::uint32_t*>(sheet.row(0));
        return std::equal(plain.begin(), plain.end(), pixels);
    }

    Sheet sheet;
    std::vector<std::uint32_t> plain;
};

TEST_P(SheetOnEveryLevel, StampsAddColourTimesWeight) {
    for (const int r : {1, 2, 5}) {
        for (const double sigma : {0.3, 0.6, 1.5}) {
            const StampedPair pair(makeFootprint(sigma, {0.4, -0.9}, r), 700, 5);
            EXPECT_TRUE(pair.equal()) << "r " << r << " sigma " << sigma;
        }
    }
}

TEST_P(SheetOnEveryLevel, FullSliceOfTheLargestColourFitsThirtyTwoBits) {
    const Footprint footprint = makeFootprint(0.5, {1, 1}, 2);
    Sheet sheet(layoutFor(footprint));
    const StampWeights weights(footprint);
    StampList list;
    for (int u = kBox.min.y; u <= kBox.max.y; ++u) {
        for (int v = kBox.min.z; v <= kBox.max.z; ++v) {
            list.places[0] = std::uint32_t(sheet.layout().stampPlace({u, v}, footprint.radius));
            list.colors[0] = {65535, 1, 0, 65535};
            list.count = 1;
            addStamps(sheet.pixels(), sheet.layout().pitchPixels(), weights, list);
        }
    }
    // Away from the edge every sheet pixel is the colour itself.
    const std::size_t middle = sheet.layout().stampPlace({5, 10}, 0);
    EXPECT_EQ(sheet.pixels()[4 * middle], 65535 * Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 1], Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 2], 0);
}

TEST_P(SheetOnEveryLevel, SettleFindsTheTilesThatAreNotZero) {
    const Footprint footprint = makeFootprint(0.4, {0, 0}, 1);
    Sheet sheet(layoutFor(footprint));
    const glm::ivec2 tiles = sheet.layout().tiles();
    for (int tile = 0; tile < tiles.x * tiles.y; ++tile) {
        for (const int corner : {0, 63}) {
            const int x = tile % tiles.x * kTilePixels + corner % 8;
            const int y = tile / tiles.x * kTilePixels + corner / 8;
            std::int32_t& value = sheet.pixels()[4 * (y * sheet.layout().pitchPixels() + x) + 3];
            value = -1;
            sheet.touch({x, y}, {x, y});
            sheet.settle();
            for (int row = 0; row < tiles.y; ++row) {
                const std::uint64_t expected =
                    row == tile / tiles.x ? std::uint64_t{1} << (tile % tiles.x) : 0;
                EXPECT_EQ(sheet.occupiedTiles(row)[0], expected);
            }
            value = 0;
            sheet.touch({x, y}, {x, y});
            sheet.settle();
            EXPECT_EQ(sheet.occupiedTiles(tile / tiles.x)[0], 0u);
        }
    }
}

TEST_P(SheetOnEveryLevel, ClearMakesTouchedPixelsZero) {
    StampedPair pair(makeFootprint(0.4, {0, 0}, 1), 500, 9);
    pair.sheet.touch({0, 0}, pair.sheet.layout().sizePixels - 1);
    pair.sheet.clear();
    for (int y = 0; y < pair.sheet.layout().sizePixels.y; ++y) {
        for (int i = 0; i < 4 * pair.sheet.layout().sizePixels.x; ++i) {
            ASSERT_EQ(pair.sheet.row(y)[i], 0);
        }
    }
    for (int row = 0; row < pair.sheet.layout().tiles().y; ++row) {
        EXPECT_EQ(pair.sheet.occupiedTiles(row)[0], 0u);
    }
}

TEST(SheetLayout, EveryFootprintStaysWithinTheSheet) {
    for (const int r : {1, 2, 3, 16}) {
        for (const double sigma : {0.2, 1.0, 4.0}) {
            const Footprint footprint = makeFootprint(sigma, {1, 1}, r);
            const SheetLayout layout = layoutFor(footprint);
            const std::size_t pitch = layout.pitchPixels();
            const std::size_t first = layout.stampPlace({kBox.min.y, kBox.min.z}, footprint.radius);
            const std::size_t last = layout.stampPlace({kBox.max.y, kBox.max.z}, -footprint.radius);
            // The outermost tiles stay free, for compositing goes one pixel over the occupied ones.
            EXPECT_GE(first % pitch, std::size_t(kTilePixels));
            EXPECT_GE(first / pitch, std::size_t(kTilePixels));
            EXPECT_LT(last % pitch + kTilePixels, std::size_t(layout.sizePixels.x));
            EXPECT_LT(last / pitch + kTilePixels, std::size_t(layout.sizePixels.y));
            EXPECT_GE(pitch, std::size_t(layout.sizePixels.x + kMaxVectorPixels));
        }
    }
}

TEST(Sheet, TouchesAcrossWordsOfTileBits) {
    const IndexBox wide{{0, 0, 0}, {0, 2000, 7}};
    Sheet sheet(layoutSheet(wide, makeFootprint(0.4, {0, 0}, 1)));
    const int width = sheet.layout().sizePixels.x;
    for (int x = 0; x < width; ++x) sheet.pixels()[4 * x] = 1;
    sheet.touch({0, 0}, {width - 1, 0});
    sheet.settle();
    int occupied = 0;
    for (const std::uint64_t word : sheet.occupiedTiles(0)) occupied += std::popcount(word);
    EXPECT_EQ(occupied, sheet.layout().tiles().x);
}

}  // namespace
}  // namespace deltasplat
