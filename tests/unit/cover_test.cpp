// SPDX-License-Identifier: Apache-2.0
// What is covered, and what of a sheet nobody sees for that, beside plain loops.
#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <random>

#include "composite/layer.h"
#include "splat/sheet_cover.h"

namespace deltasplat {
namespace {

// Patches of cells and cells by themselves, about half of all.
CoveredCells randomCells(const PlaneBox& box, std::uint32_t seed) {
    std::mt19937 random(seed);
    CoveredCells cells(box);
    for (int y = 0; y < cells.size().y; ++y) {
        for (int x = 0; x < cells.size().x; ++x) {
            const bool inPatch = x / 5 % 2 == y / 4 % 2;
            if (inPatch != (random() % 16 == 0)) cells.cover({x, y});
        }
    }
    cells.settle();
    return cells;
}

bool isCovered(const CoveredCells& cells, glm::ivec2 pixel) {
    return cells.isCovered((pixel - cells.box().min) / CoveredCells::kCellPixels);
}

TEST(CoveredCells, CoverWhatAllCellsOfABoxCover) {
    const CoveredCells cells = randomCells({{-7, 3}, {90, 78}}, 1);
    EXPECT_EQ(cells.size(), glm::ivec2(13, 10));
    EXPECT_TRUE(cells.any());
    EXPECT_FALSE(cells.all());
    for (int y0 = 0; y0 <= cells.size().y; ++y0) {
        for (int y1 = y0; y1 <= cells.size().y; ++y1) {
            for (int x0 = 0; x0 <= cells.size().x; ++x0) {
                for (int x1 = x0; x1 <= cells.size().x; ++x1) {
                    bool expected = true;
                    for (int y = y0; y < y1; ++y)
                        for (int x = x0; x < x1; ++x) expected &= cells.isCovered({x, y});
                    ASSERT_EQ(cells.rows({y0, y1}).cover({x0, x1}), expected);
                }
            }
        }
    }
}

TEST(CoveredCells, KnowTheirPixels) {
    CoveredCells cells({{-7, 3}, {90, 78}});
    EXPECT_FALSE(cells.any());
    EXPECT_EQ(cells.pixelsOf({12, 9}).min, glm::ivec2(89, 75));
    EXPECT_EQ(cells.pixelsOf({12, 9}).max, glm::ivec2(90, 78));
    EXPECT_EQ(cells.cellsOf(0, {-100, 100}), glm::ivec2(0, 13));
    EXPECT_EQ(cells.cellsOf(0, {0, 1}), glm::ivec2(0, 1));
    EXPECT_EQ(cells.cellsOf(0, {1, 2}), glm::ivec2(1, 2));
    EXPECT_EQ(cells.cellsOf(1, {10, 12}), glm::ivec2(0, 2));
    for (const glm::ivec2 pixels : {glm::ivec2(100, 120), {INT_MAX, 0}, {INT_MIN, INT_MIN}}) {
        const glm::ivec2 none = cells.cellsOf(1, pixels);
        EXPECT_EQ(none.x, none.y);
    }
    for (int y = 0; y < cells.size().y; ++y)
        for (int x = 0; x < cells.size().x; ++x) cells.cover({x, y});
    cells.settle();
    EXPECT_TRUE(cells.all());
    EXPECT_TRUE(CoveredCells().all());
}

// One that lets the least of light through covers nothing, for that may be a bit of the picture.
TEST(FindCovered, TakesCellsThatAreOpaqueToTheLastBit) {
    for (const int channels : {1, 4}) {
        Layer layer({{-3, 2}, {40, 30}}, channels);
        const auto paint = [&](const PlaneBox& box, float opacity) {
            for (int y = box.min.y; y < box.max.y; ++y) {
                layer.extend(y, box.min.x, box.max.x);
                for (int x = box.min.x; x < box.max.x; ++x)
                    layer.pixel({x, y})[channels - 1] = opacity;
            }
        };
        paint({{0, 5}, {33, 28}}, 1);
        layer.pixel({14, 12})[channels - 1] = std::nextafter(1.0f, 0.0f);
        CoveredCells cells({{-3, 4}, {40, 25}});
        addCovered(layer, cells);
        for (int y = 0; y < cells.size().y; ++y) {
            for (int x = 0; x < cells.size().x; ++x) {
                const PlaneBox pixels = cells.pixelsOf({x, y});
                bool expected = true;
                for (int v = pixels.min.y; v < pixels.max.y; ++v)
                    for (int u = pixels.min.x; u < pixels.max.x; ++u)
                        expected &= layer.pixel({u, v})[channels - 1] == 1.0f;
                ASSERT_EQ(cells.isCovered({x, y}), expected) << x << ' ' << y;
            }
        }
        EXPECT_TRUE(cells.isCovered({1, 2}));
        EXPECT_FALSE(cells.isCovered({2, 1}));
        EXPECT_FALSE(cells.isCovered({4, 2}));
        // What was covered stays so.
        addCovered(Layer({{-3, 2}, {40, 30}}, channels), cells);
        EXPECT_TRUE(cells.isCovered({1, 2}));
    }
}

// Whether all pixels that read sheet pixels [first, last) are covered, `slack` more around these.
bool isHidden(const CoveredCells& cells, const SheetReading& reading, glm::ivec2 first,
              glm::ivec2 last, double slack) {
    const double reach = readingReach(reading) + slack;
    const PlaneBox& box = cells.box();
    for (int y = box.min.y; y < box.max.y; ++y) {
        for (int x = box.min.x; x < box.max.x; ++x) {
            const glm::dvec2 at =
                reading.scale * glm::dvec2(x, y) + glm::dvec2(reading.offset) + reading.fraction;
            const bool reads = at.x > first.x - reach && at.x < last.x - 1 + reach &&
                               at.y > first.y - reach && at.y < last.y - 1 + reach;
            if (reads && !isCovered(cells, {x, y})) return false;
        }
    }
    return true;
}

// Who reads some sheet pixels at scale 1, by asking each pixel of the box: those to which they lie
// nearer than a pixel.
TEST(SheetReading, ReadersAtOnePixelAreThoseThatReachIt) {
    for (const double fraction : {0.0, 0.25}) {
        for (const int offset : {-40, -3, 0, 5, 60}) {
            const SheetReading reading{{offset, -offset}, {fraction, fraction}, 1};
            const PlaneBox box{{-20, -7}, {30, 25}};
            for (int axis = 0; axis < 2; ++axis) {
                for (int first = -5; first < 20; first += 4) {
                    const glm::ivec2 found = readersOf(reading, axis, first, first + 6, box);
                    for (int pixel = box.min[axis]; pixel < box.max[axis]; ++pixel) {
                        const double at = pixel + reading.offset[axis] + fraction;
                        const bool reads = at > first - 1 && at < first + 6;
                        const bool isFound = pixel >= found.x && pixel < found.y;
                        ASSERT_TRUE(!reads || isFound) << offset << ' ' << first << ' ' << pixel;
                        // One pixel more to each side is none too many.
                        ASSERT_TRUE(!isFound || (at > first - 2.5 && at < first + 7.5));
                    }
                }
            }
        }
    }
    // A plane that lies far away has none.
    for (const int offset : {-2'000'000'000, 2'000'000'000}) {
        const glm::ivec2 found = readersOf({{offset, 0}, {0.5, 0}, 1}, 0, 0, 100'000,
                                           PlaneBox{{-100'000, 0}, {100'000, 1}});
        EXPECT_EQ(found.x, found.y);
    }
}

// A run of blocks in a row is hidden where each of them is, unless nobody reads its ends.
void expectRunsHideTheirBlocks(const SheetCover& cover, const SheetLayout& layout) {
    for (int v = 0; v < layout.blocks.y; ++v) {
        for (int first = 0; first < layout.blocks.x; ++first) {
            bool hidesEach = true;
            for (int last = first; last < layout.blocks.x; ++last) {
                hidesEach = hidesEach && cover.blockRow(v).hides(last);
                ASSERT_TRUE(hidesEach || !cover.blockRow(v).hides(first, last));
            }
        }
    }
}

TEST(SheetCover, HidesWhatCoveredPixelsAloneRead) {
    for (const int resolution : {1, 2, 3}) {
        SheetLayout layout;
        layout.resolution = resolution;
        layout.blocks = {6, 5};
        layout.reachPixels = 2;
        layout.footprintPixels = 5;
        layout.marginPixels = 16;
        layout.sizePixels = 8 * resolution * layout.blocks + 2 * layout.marginPixels;
        const CoveredCells cells = randomCells({{-30, -20}, {130, 110}}, std::uint32_t(resolution));
        int hidden = 0;
        for (const SheetReading& reading :
             {SheetReading{{3, -5}, {0, 0}, 1}, SheetReading{{3, -5}, {0.25, 0.75}, 1},
              SheetReading{{-8, 9}, {0.5, 0.1}, 0.6}, SheetReading{{12, 7}, {0.2, 0.9}, 1.7}}) {
            SheetCover cover;
            cover.set(cells, reading, reading, layout);
            for (int v = 0; v < layout.blocks.y; ++v) {
                for (int u = 0; u < layout.blocks.x; ++u) {
                    const glm::ivec2 first = 8 * resolution * glm::ivec2(u, v) + 14;
                    const glm::ivec2 last = first + 7 * resolution + 5;
                    const bool hides = cover.blockRow(v).hides(u);
                    hidden += hides;
                    ASSERT_TRUE(!hides || isHidden(cells, reading, first, last, 0));
                    // It is not much more careful than it has to be: a cell is not more.
                    ASSERT_TRUE(hides || !isHidden(cells, reading, first, last, 10));
                }
            }
            expectRunsHideTheirBlocks(cover, layout);
            for (int v = 0; v < layout.tiles().y; ++v) {
                for (int u = 0; u < layout.tiles().x; ++u) {
                    const glm::ivec2 first = kTilePixels * glm::ivec2(u, v);
                    const bool hides = cover.tileRow(v).hides(u);
                    ASSERT_TRUE(!hides || isHidden(cells, reading, first, first + kTilePixels, 0));
                    ASSERT_TRUE(hides || !isHidden(cells, reading, first, first + kTilePixels, 10));
                }
            }
        }
        EXPECT_GT(hidden, 0);
    }
}

// Of several slices, what none of those between shows.
TEST(SheetCover, HidesFromNowOnWhatEachSliceHides) {
    SheetLayout layout;
    layout.blocks = {12, 9};
    layout.reachPixels = 1;
    layout.footprintPixels = 3;
    layout.marginPixels = 16;
    layout.sizePixels = 8 * layout.blocks + 2 * layout.marginPixels;
    const CoveredCells cells = randomCells({{-30, -20}, {130, 110}}, 7);
    const auto readingOfSlice = [](int slice) {
        return SheetReading{{3 - slice, -5 + slice / 2}, {0.25, 0.5 * (slice % 2)}, 1};
    };
    SheetCover all;
    all.set(cells, readingOfSlice(0), readingOfSlice(11), layout);
    expectRunsHideTheirBlocks(all, layout);
    int hidden = 0;
    int runs = 0;
    for (int slice = 0; slice < 12; ++slice) {
        SheetCover one;
        one.set(cells, readingOfSlice(slice), readingOfSlice(slice), layout);
        for (int v = 0; v < layout.blocks.y; ++v) {
            for (int u = 0; u < layout.blocks.x; ++u) {
                runs += u > 0 && all.blockRow(v).hides(u - 1, u);
                if (!all.blockRow(v).hides(u)) continue;
                ++hidden;
                ASSERT_TRUE(one.blockRow(v).hides(u)) << slice;
            }
        }
    }
    EXPECT_GT(hidden, 0);
    EXPECT_GT(runs, 0);
}

TEST(SheetCover, ClearsBitsOfHiddenTiles) {
    SheetLayout layout;
    layout.blocks = {70, 2};
    layout.marginPixels = 16;
    layout.sizePixels = 8 * layout.blocks + 2 * layout.marginPixels;
    const CoveredCells cells = randomCells({{0, 0}, layout.sizePixels}, 3);
    SheetCover cover;
    cover.set(cells, {}, {}, layout);
    std::mt19937_64 random(5);
    for (int row = 0; row < layout.tiles().y; ++row) {
        std::vector<std::uint64_t> bits(16);
        for (std::uint64_t& word : bits) word = random();
        for (std::size_t i = 1; i < bits.size(); i += 2) bits[i] &= 0x3FF;
        std::vector<std::uint64_t> left = bits;
        cover.clearHidden(row, 2, left);
        for (int tile = 0; tile < layout.tiles().x; ++tile) {
            for (std::size_t y = 0; y < 8; ++y) {
                const std::size_t place = 2 * y + std::size_t(tile / 64);
                const bool was = bits[place] >> tile % 64 & 1;
                ASSERT_EQ(left[place] >> tile % 64 & 1, was && !cover.tileRow(row).hides(tile));
            }
        }
    }
}

}  // namespace
}  // namespace deltasplat
