// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "deltasplat/simd.h"
#include "splat/stamp_kernels.h"

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

std::vector<ClassTable::Color> randomColors(std::mt19937& random) {
    std::uniform_int_distribution<int> value(0, ClassTable::kMax);
    std::vector<ClassTable::Color> colors(100);
    for (ClassTable::Color& color : colors) {
        for (std::int16_t& channel : color) channel = std::int16_t(value(random));
    }
    return colors;
}

// Where the stamps of a block's voxels go, from its first one's.
std::array<std::uint32_t, 64> placesInBlock(const SheetLayout& layout) {
    std::array<std::uint32_t, 64> places;
    for (int n = 0; n < 64; ++n) {
        const glm::ivec2 voxel = layout.firstVoxel + glm::ivec2(n % 8, n / 8);
        places[n] = std::uint32_t(layout.stampPlace(voxel) - layout.stampPlace(layout.firstVoxel));
    }
    return places;
}

// Adds stamps of random blocks to a sheet and to a plain array at once.
struct StampedPair {
    StampedPair(const Footprint& footprint, int blocks, std::uint32_t seed, int channelCount = 4)
        : channels(channelCount),
          sheet(layoutSheet(kBox, footprint, channels)),
          plain(sheet.pitch() * sheet.layout().sizePixels.y) {
        std::mt19937 random(seed);
        const SheetLayout& layout = sheet.layout();
        const std::vector<ClassTable::Color> colors = randomColors(random);
        const std::array<std::uint32_t, 64> places = placesInBlock(layout);
        const StampWeights weights(footprint, channels);
        std::array<std::uint16_t, 64> classes;
        std::array<std::uint16_t, 64> shown;
        for (int i = 0; i < blocks; ++i) {
            for (std::uint16_t& next : classes) next = std::uint16_t(random() % colors.size());
            for (std::uint16_t& last : shown) last = std::uint16_t(random() % colors.size());
            const auto before = shown;
            std::uint64_t active = random();
            active = active << 32 | random();
            const glm::ivec2 block(random() % layout.blocks.x, random() % layout.blocks.y);
            const std::size_t first = layout.stampPlace(layout.firstVoxel + 8 * block);
            const BlockSlice voxels{classes.data(), active, places.data()};
            const StampTarget target{sheet.pixels() + channels * first, sheet.pitch()};
            const bool whole = i % 2 == 0;
            if (whole) {
                stampWhole(voxels, colors.data(), weights, target);
            } else {
                stampChanges(voxels, colors.data(), shown.data(), weights, target);
            }
            for (int n = 0; n < 64; ++n) {
                const bool counts = active >> n & 1;
                EXPECT_EQ(shown[n], counts && !whole ? classes[n] : before[n]);
                if (!counts) continue;
                for (int c = 0; c < channels; ++c) {
                    const int channel = channels == 4 ? c : 3;
                    const int color = colors[classes[n]][channel];
                    addPlain(footprint, first + places[n], c,
                             whole ? color : color - colors[before[n]][channel]);
                }
            }
        }
    }

    void addPlain(const Footprint& footprint, std::size_t place, int c, int value) {
        for (int y = 0; y < footprint.width; ++y) {
            for (int x = 0; x < footprint.width; ++x) {
                // Unsigned, because sums of random colours may leave the range that real ones keep
                // to.
                plain[channels * (place + y * sheet.layout().pitchPixels() + x) + c] +=
                    std::uint32_t(value) * std::uint32_t(footprint.at(x, y));
            }
        }
    }

    bool equal() const {
        const auto* pixels = reinterpret_cast<const std::uint32_t*>(sheet.row(0));
        return std::equal(plain.begin(), plain.end(), pixels);
    }

    int channels;
    Sheet sheet;
    std::vector<std::uint32_t> plain;
};

TEST_P(SheetOnEveryLevel, StampsAddColourTimesWeight) {
    for (const int r : {1, 2, 5}) {
        for (const double sigma : {0.3, 0.6, 1.5}) {
            for (const int channels : {1, 4}) {
                const StampedPair pair(makeFootprint(sigma, {0.4, -0.9}, r), 20, 5, channels);
                EXPECT_TRUE(pair.equal()) << "r " << r << " sigma " << sigma << ' ' << channels;
            }
        }
    }
}

TEST_P(SheetOnEveryLevel, StampsOfEveryWidth) {
    for (int width = 1; width <= 9; ++width) {
        for (const int channels : {1, 4}) {
            const StampedPair pair(makeFootprint(1, {0.4, -0.9}, 1, width), 20, 6, channels);
            EXPECT_TRUE(pair.equal()) << width << ' ' << channels;
        }
    }
}

TEST_P(SheetOnEveryLevel, FullSliceOfTheLargestColourFitsThirtyTwoBits) {
    const Footprint footprint = makeFootprint(0.5, {1, 1}, 2);
    Sheet sheet(layoutSheet(kBox, footprint));
    const StampWeights weights(footprint, 4);
    const std::vector<ClassTable::Color> colors = {{}, {ClassTable::kMax, 1, 0, ClassTable::kMax}};
    const std::array<std::uint32_t, 64> places = placesInBlock(sheet.layout());
    std::array<std::uint16_t, 64> classes;
    classes.fill(1);
    for (int v = 0; v < sheet.layout().blocks.x; ++v) {
        for (int u = 0; u < sheet.layout().blocks.y; ++u) {
            const glm::ivec2 voxel = sheet.layout().firstVoxel + 8 * glm::ivec2(v, u);
            const std::size_t place = sheet.layout().stampPlace(voxel);
            stampWhole({classes.data(), ~std::uint64_t{0}, places.data()}, colors.data(), weights,
                       {sheet.pixels() + 4 * place, sheet.pitch()});
        }
    }
    // Away from the edge every sheet pixel is the colour itself.
    const std::size_t middle = sheet.layout().stampPlace({10, 5});
    EXPECT_EQ(sheet.pixels()[4 * middle], ClassTable::kMax * Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 1], Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 2], 0);
}

TEST_P(SheetOnEveryLevel, SettleFindsTheRowsThatAreNotZero) {
    const Footprint footprint = makeFootprint(0.4, {0, 0}, 1);
    for (const int channels : {1, 4}) {
        Sheet sheet(layoutSheet(kBox, footprint, channels));
        const glm::ivec2 tiles = sheet.layout().tiles();
        for (int tile = 0; tile < tiles.x * tiles.y; ++tile) {
            const glm::ivec2 column(tile % tiles.x, tile / tiles.x);
            for (const int corner : {0, 7, 27, 63}) {
                const glm::ivec2 p = 8 * column + glm::ivec2(corner % 8, corner / 8);
                std::int32_t& value =
                    sheet.pixels()[sheet.pitch() * p.y + channels * (p.x + 1) - 1];
                value = -1;
                sheet.touch({p, p});
                sheet.settle();
                for (int row = 0; row < tiles.y; ++row) {
                    for (int x = 0; x < tiles.x; ++x) {
                        const int expected = glm::ivec2(x, row) == column ? 1 << (corner / 8) : 0;
                        EXPECT_EQ(sheet.fullRows(row)[x], expected);
                    }
                }
                value = 0;
                sheet.touch({p, p});
                sheet.settle();
                EXPECT_EQ(sheet.fullRows(column.y)[column.x], 0);
            }
        }
    }
}

TEST_P(SheetOnEveryLevel, FullRowsAreLookedAtAgainOnlyIfTouched) {
    Sheet sheet(layoutSheet(kBox, makeFootprint(0.4, {0, 0}, 1)));
    const glm::ivec2 p(17, 20);
    const SheetBox all{{0, 0}, sheet.layout().sizePixels - 1};
    const auto full = [&] { return sheet.fullRows(p.y / 8)[std::size_t(p.x / 8)]; };
    std::int32_t& value = sheet.pixels()[sheet.pitch() * p.y + 4 * p.x];
    value = 5;
    sheet.touchUnlessFull(all);
    sheet.settle();
    EXPECT_EQ(full(), 1 << p.y % 8);
    value = 0;
    sheet.touchUnlessFull(all);
    sheet.settle();
    EXPECT_EQ(full(), 1 << p.y % 8);
    sheet.touch({p, p});
    sheet.settle();
    EXPECT_EQ(full(), 0);
}

TEST(Sheet, RefillsRowsOfTilesOnceTheyAreAskedFor) {
    Sheet sheet(layoutSheet(kBox, makeFootprint(0.4, {0, 0}, 1)));
    const int rows = sheet.layout().tiles().y;
    ASSERT_GE(rows, 5);
    sheet.touch({{0, 0}, sheet.layout().sizePixels - 1});
    const auto refilled = [&](int first, int last) {
        std::vector<int> found;
        sheet.refillTouched(first, last, [&](int row, const auto& touched, const auto&) {
            EXPECT_EQ(touched[0], 0xFF);
            found.push_back(row);
        });
        return found;
    };
    EXPECT_EQ(refilled(10, 17), (std::vector<int>{1, 2}));
    EXPECT_EQ(refilled(-9, 9), std::vector<int>{0});
    EXPECT_EQ(refilled(5, 5), std::vector<int>{});
    EXPECT_EQ(refilled(24, 25), std::vector<int>{3});
    EXPECT_EQ(refilled(0, 40), std::vector<int>{4});
}

TEST_P(SheetOnEveryLevel, ClearMakesTouchedPixelsZero) {
    for (const int channels : {1, 4}) {
        StampedPair pair(makeFootprint(0.4, {0, 0}, 1), 12, 9, channels);
        const glm::ivec2 size = pair.sheet.layout().sizePixels;
        pair.sheet.touch({{0, 0}, size - 1});
        pair.sheet.clear();
        for (int y = 0; y < size.y; ++y) {
            for (int i = 0; i < channels * size.x; ++i) ASSERT_EQ(pair.sheet.row(y)[i], 0);
        }
        for (int row = 0; row < pair.sheet.layout().tiles().y; ++row) {
            for (const std::uint8_t full : pair.sheet.fullRows(row)) EXPECT_EQ(full, 0);
        }
    }
}

TEST(SheetLayout, EveryFootprintStaysWithinTheSheet) {
    for (const int r : {1, 2, 3, 16}) {
        for (const double sigma : {0.2, 1.0, 4.0}) {
            const Footprint footprint = makeFootprint(sigma, {1, 1}, r);
            const SheetLayout layout = layoutSheet(kBox, footprint);
            const std::size_t pitch = layout.pitchPixels();
            const std::size_t first = layout.stampPlace({kBox.min.z, kBox.min.y});
            const std::size_t last =
                layout.stampPlace({kBox.max.z, kBox.max.y}) + (footprint.width - 1) * (pitch + 1);
            // The outermost tiles stay free, for compositing goes one pixel over the full ones.
            EXPECT_GE(first % pitch, std::size_t(kTilePixels));
            EXPECT_GE(first / pitch, std::size_t(kTilePixels));
            EXPECT_LT(last % pitch + kTilePixels, std::size_t(layout.sizePixels.x));
            EXPECT_LT(last / pitch + kTilePixels, std::size_t(layout.sizePixels.y));
        }
    }
}

// The rows that a part of a sheet was asked for: no block outside of it reaches them, and it has no
// block more than it needs.
TEST(SheetLayout, PartsHaveTheBlocksThatReachTheirRows) {
    for (const int r : {1, 2, 3}) {
        for (const int width : {r + 1, 2 * r + 1, 4 * r + 2, 40}) {
            const SheetLayout whole = layoutSheet(kBox, makeFootprint(0.5, {0.3, 0.9}, r, width));
            const auto reaches = [&](int block, int first, int last) {
                const int begin = whole.marginPixels - whole.reachPixels + 8 * r * block;
                return begin < last && begin + 7 * r + width > first;
            };
            for (int first = 0; first < whole.sizePixels.y; first += 5) {
                for (int last = first + 1; last <= whole.sizePixels.y; last += 7) {
                    const SheetLayout part = layoutRows(whole, first, last);
                    const int firstBlock = (part.firstVoxel.y - whole.firstVoxel.y) / 8;
                    for (int block = 0; block < whole.blocks.y; ++block) {
                        const bool has = block >= firstBlock && block < firstBlock + part.blocks.y;
                        EXPECT_EQ(has, reaches(block, first, last)) << block;
                    }
                    EXPECT_EQ(part.originRow, 8 * r * firstBlock);
                    EXPECT_EQ(part.sizePixels.y, 8 * r * part.blocks.y + 2 * whole.marginPixels);
                    // A voxel's stamp lies where it lies in the whole.
                    const glm::ivec2 voxel = part.firstVoxel;
                    EXPECT_EQ(part.stampPlace(voxel) + part.originRow * whole.pitchPixels(),
                              whole.stampPlace(voxel));
                }
            }
        }
    }
}

TEST(Sheet, TouchesNoMoreThanItIsTold) {
    const IndexBox wide{{0, 0, 0}, {0, 7, 2000}};
    Sheet sheet(layoutSheet(wide, makeFootprint(0.4, {0, 0}, 1)));
    const int width = sheet.layout().sizePixels.x;
    for (int x = 0; x < width; ++x) {
        for (const int y : {2, 3, 4}) sheet.pixels()[y * sheet.pitch() + 4 * x] = 1;
    }
    sheet.touch({{100, 2}, {width - 1, 3}});
    sheet.settle();
    for (int x = 0; x < sheet.layout().tiles().x; ++x) {
        EXPECT_EQ(sheet.fullRows(0)[x] & 0b1100, x >= 100 / 8 ? 0b1100 : 0) << x;
    }
}

}  // namespace
}  // namespace deltasplat
