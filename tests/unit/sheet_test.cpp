// SPDX-License-Identifier: Apache-2.0
#include "splat/sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "base/bits.h"
#include "deltasplat/simd.h"
#include "splat/stamp_kernels.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

class SheetOnEveryLevel : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { setSimdLevel(GetParam()); }
    void TearDown() override { setSimdLevel("auto"); }
};

INSTANTIATE_TEST_SUITE_P(Simd, SheetOnEveryLevel, testing::ValuesIn(test::testedSimdLevels()),
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
            const BlockStamps stamps{transposedBits(active), classes.data(), shown.data(),
                                     sheet.pixels() + channels * first};
            const StampPlaces in{places.data(), sheet.pitch()};
            const bool whole = i % 2 == 0;
            if (whole) {
                stampWhole({&stamps, 1}, colors.data(), weights, in);
            } else {
                stampChanges({&stamps, 1}, colors.data(), weights, in);
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

// Blocks with one, all, and some voxels, in one call and in one for each.
TEST_P(SheetOnEveryLevel, BlocksAreStampedOneAfterTheOther) {
    for (const int width : {3, 6, 9}) {
        const Footprint footprint = makeFootprint(1, {0.4, -0.9}, 1, width);
        const StampWeights weights(footprint, 4);
        Sheet together(layoutSheet(kBox, footprint));
        Sheet alone(layoutSheet(kBox, footprint));
        const SheetLayout& layout = alone.layout();
        std::mt19937 random(3);
        const std::vector<ClassTable::Color> colors = randomColors(random);
        const std::array<std::uint32_t, 64> places = placesInBlock(layout);
        const std::uint64_t actives[] = {1, ~std::uint64_t{0}, std::uint64_t{1} << 63, 0x8100,
                                         0x123456789ABCDEF0};
        std::vector<std::array<std::uint16_t, 64>> classes(std::size(actives));
        std::vector<std::array<std::uint16_t, 64>> shown(std::size(actives));
        std::vector<std::array<std::uint16_t, 64>> shownAlone(std::size(actives));
        std::vector<BlockStamps> stamps;
        for (std::size_t i = 0; i < std::size(actives); ++i) {
            for (std::uint16_t& next : classes[i]) next = std::uint16_t(random() % colors.size());
            const glm::ivec2 block(i % layout.blocks.x, i / 2 % layout.blocks.y);
            const std::size_t first = 4 * layout.stampPlace(layout.firstVoxel + 8 * block);
            stamps.push_back(
                {actives[i], classes[i].data(), shown[i].data(), together.pixels() + first});
            const BlockStamps one{actives[i], classes[i].data(), shownAlone[i].data(),
                                  alone.pixels() + first};
            stampChanges({&one, 1}, colors.data(), weights, {places.data(), alone.pitch()});
        }
        stampChanges(stamps, colors.data(), weights, {places.data(), together.pitch()});
        stampChanges({}, colors.data(), weights, {places.data(), together.pitch()});
        stampWhole({}, colors.data(), weights, {places.data(), together.pitch()});
        EXPECT_EQ(shown, shownAlone);
        const std::size_t count = together.pitch() * layout.sizePixels.y;
        EXPECT_TRUE(std::equal(alone.row(0), alone.row(0) + count, together.row(0))) << width;
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
            const BlockStamps stamps{~std::uint64_t{0}, classes.data(), nullptr,
                                     sheet.pixels() + 4 * place};
            stampWhole({&stamps, 1}, colors.data(), weights, {places.data(), sheet.pitch()});
        }
    }
    // Away from the edge every sheet pixel is the colour itself.
    const std::size_t middle = sheet.layout().stampPlace({10, 5});
    EXPECT_EQ(sheet.pixels()[4 * middle], ClassTable::kMax * Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 1], Footprint::kOne);
    EXPECT_EQ(sheet.pixels()[4 * middle + 2], 0);
}

// Of one pixel, so that a voxel reaches one row of one tile.
const Footprint& pixelFootprint() {
    static const Footprint footprint = makeFootprint(0.4, {0, 0}, 1, 1);
    return footprint;
}

// Where a voxel of a block is: a tile, as there is one pixel a voxel.
struct VoxelPlace {
    VoxelPlace(Sheet& sheet, glm::ivec2 inBlock, int voxel)
        : block(inBlock),
          bit(std::uint64_t{1} << voxel),
          tile(inBlock + sheet.layout().marginPixels / kTilePixels) {
        const glm::ivec2 p = 8 * tile + glm::ivec2(voxel % 8, voxel / 8);
        const int channels = sheet.layout().channels;
        value = &sheet.pixels()[sheet.pitch() * p.y + channels * (p.x + 1) - 1];
    }

    glm::ivec2 block;
    std::uint64_t bit;
    glm::ivec2 tile;
    std::int32_t* value;  // the last channel
};

TEST_P(SheetOnEveryLevel, SettleFindsTheRowsThatAreNotZero) {
    for (const int channels : {1, 4}) {
        Sheet sheet(layoutSheet(kBox, pixelFootprint(), channels));
        const glm::ivec2 tiles = sheet.layout().tiles();
        const glm::ivec2 blocks = sheet.layout().blocks;
        for (int block = 0; block < blocks.x * blocks.y; ++block) {
            for (const int voxel : {0, 7, 27, 63}) {
                const VoxelPlace place(sheet, {block % blocks.x, block / blocks.x}, voxel);
                *place.value = -1;
                sheet.touch(place.block, place.bit);
                sheet.settle();
                for (int row = 0; row < tiles.y; ++row) {
                    for (int x = 0; x < tiles.x; ++x) {
                        const bool here = glm::ivec2(x, row) == place.tile;
                        EXPECT_EQ(sheet.fullRows(row)[x], here ? 1 << (voxel / 8) : 0);
                    }
                }
                *place.value = 0;
                sheet.touch(place.block, place.bit);
                sheet.settle();
                EXPECT_EQ(sheet.fullRows(place.tile.y)[place.tile.x], 0);
            }
        }
    }
}

TEST_P(SheetOnEveryLevel, RowsAreFullWhereVoxelsAreSeenAndLookedAtWhereTheyAreGone) {
    Sheet sheet(layoutSheet(kBox, pixelFootprint()));
    const VoxelPlace place(sheet, {1, 2}, 27);
    const auto full = [&] { return sheet.fullRows(place.tile.y)[std::size_t(place.tile.x)]; };
    *place.value = 5;
    sheet.show(place.block, place.bit, 0);
    sheet.settle();
    EXPECT_EQ(full(), 1 << 3);
    // Another voxel of the row is seen still, so that nobody looks.
    *place.value = 0;
    sheet.show(place.block, place.bit << 1, place.bit);
    sheet.settle();
    EXPECT_EQ(full(), 1 << 3);
    sheet.show(place.block, 0, place.bit << 1);
    sheet.settle();
    EXPECT_EQ(full(), 0);
    *place.value = 5;
    sheet.show(place.block, 0, place.bit);
    sheet.settle();
    EXPECT_EQ(full(), 1 << 3);
}

// Every pixel that any of some voxels' footprints covers, and no other row of a tile.
TEST(BlockReach, IsThatOfItsVoxelsFootprints) {
    std::mt19937_64 random(1);
    for (const int r : {1, 2, 3, 5}) {
        for (const int width : {r, 2 * r + 1, 6 * r, 40}) {
            const BlockReach reach(r, width / 2, width);
            for (int i = 0; i < 50; ++i) {
                const std::uint64_t voxels = random() & random() & random() & random();
                const int tiles = reach.tiles();
                std::vector<unsigned> expected(std::size_t(tiles) * tiles);
                for (int n = 0; n < 64; ++n) {
                    if ((voxels >> n & 1) == 0) continue;
                    const glm::ivec2 first =
                        r * glm::ivec2(n % 8, n / 8) - width / 2 - 8 * reach.firstTile();
                    ASSERT_GE(std::min(first.x, first.y), 0);
                    ASSERT_LE(std::max(first.x, first.y) + width, 8 * tiles);
                    for (int y = first.y; y < first.y + width; ++y) {
                        for (int x = first.x; x < first.x + width; ++x)
                            expected[std::size_t(y / 8 * tiles + x / 8)] |= 1u << y % 8;
                    }
                }
                for (int x = 0; x < tiles; ++x) {
                    const std::uint8_t rows = reach.rowsReaching(x, voxels);
                    for (int y = 0; y < tiles; ++y) {
                        EXPECT_EQ(reach.pixelRows(y / 8, rows) >> 8 * (y % 8) & 0xFF,
                                  expected[std::size_t(y * tiles + x)]);
                    }
                }
            }
        }
    }
}

// Touches all that voxels may reach.
void touchAll(Sheet& sheet) {
    const glm::ivec2 blocks = sheet.layout().blocks;
    for (int i = 0; i < blocks.x * blocks.y; ++i)
        sheet.touch({i % blocks.x, i / blocks.x}, ~std::uint64_t{0});
}

TEST(Sheet, RefillsRowsOnceTheyAreAskedFor) {
    Sheet sheet(layoutSheet(kBox, pixelFootprint()));
    ASSERT_EQ(sheet.layout().tiles().y, 7);
    touchAll(sheet);
    // Rows of tiles, and which of their rows.
    using Rows = std::vector<std::pair<int, unsigned>>;
    const auto refilled = [&](int first, int last) {
        Rows found;
        sheet.refillTouched(first, last, [&](int row, const auto& touched, const auto&) {
            if (touched[1] != 0) found.emplace_back(row, touched[1]);
        });
        return found;
    };
    EXPECT_EQ(refilled(10, 17), (Rows{{1, 0xFC}, {2, 0x01}}));
    EXPECT_EQ(refilled(-9, 9), (Rows{{1, 0x01}}));
    EXPECT_EQ(refilled(25, 25), Rows{});
    EXPECT_EQ(refilled(26, 29), (Rows{{3, 0x1C}}));
    EXPECT_EQ(refilled(24, 32), (Rows{{3, 0xE3}}));
    // Voxels do not reach the outermost tiles.
    EXPECT_EQ(refilled(0, 90), (Rows{{1, 0x02}, {2, 0xFE}, {4, 0xFF}, {5, 0xFF}}));
    EXPECT_EQ(refilled(0, 90), Rows{});
}

// What is hidden stays touched, and so do rows that nobody asks for.
TEST(Sheet, RowsOfHiddenTilesAreLeftAsWell) {
    Sheet sheet(layoutSheet(kBox, pixelFootprint()));
    touchAll(sheet);
    std::vector<unsigned> found;
    const auto refill = [&](int row, const auto& touched, const auto&) {
        if (row == 1) found = {touched[1], touched[2]};
    };
    sheet.refillTouched(
        10, 13, [](glm::ivec2 tile) { return tile.x == 2; }, refill);
    EXPECT_EQ(found, (std::vector<unsigned>{0x1C, 0}));
    sheet.refillTouched(8, 16, refill);
    EXPECT_EQ(found, (std::vector<unsigned>{0xE3, 0xFF}));
}

TEST_P(SheetOnEveryLevel, ClearMakesTouchedPixelsZero) {
    for (const int channels : {1, 4}) {
        StampedPair pair(makeFootprint(0.4, {0, 0}, 1), 12, 9, channels);
        const glm::ivec2 size = pair.sheet.layout().sizePixels;
        touchAll(pair.sheet);
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
                    const SheetLayout part =
                        layoutPart(whole, {{0, first}, {whole.sizePixels.x, last}});
                    const int firstBlock = (part.firstVoxel.y - whole.firstVoxel.y) / 8;
                    for (int block = 0; block < whole.blocks.y; ++block) {
                        const bool has = block >= firstBlock && block < firstBlock + part.blocks.y;
                        EXPECT_EQ(has, reaches(block, first, last)) << block;
                    }
                    EXPECT_EQ(part.origin, glm::ivec2(0, 8 * r * firstBlock));
                    EXPECT_EQ(part.sizePixels.y, 8 * r * part.blocks.y + 2 * whole.marginPixels);
                    // A voxel's stamp lies where it lies in the whole.
                    const glm::ivec2 voxel = part.firstVoxel;
                    EXPECT_EQ(part.stampPlace(voxel) + part.origin.y * whole.pitchPixels(),
                              whole.stampPlace(voxel));
                }
            }
        }
    }
}

}  // namespace
}  // namespace deltasplat
