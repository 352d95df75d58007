// SPDX-License-Identifier: Apache-2.0
#include "composite/compositor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "composite/layer.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/simd.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

constexpr IndexBox kBox{{0, -3, 5}, {30, 20, 30}};  // slice, u, v
constexpr float kScale = 1.0f / (float(ClassTable::kMax) * Footprint::kOne);

// A sheet with random colours in some of its inner tiles and zeros elsewhere.
Sheet randomSheet(std::uint32_t seed, int channels = 4) {
    Sheet sheet(layoutSheet(kBox, makeFootprint(0.4, {0, 0}, 1), channels));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    // At one pixel a voxel, blocks are as large as tiles.
    const glm::ivec2 blocks = sheet.layout().blocks;
    const int margin = sheet.layout().marginPixels / kTilePixels;
    for (int y = margin; y < margin + blocks.y; ++y) {
        for (int x = margin; x < margin + blocks.x; ++x) {
            if (uniform(random) > 0.5) continue;
            for (int n = 0; n < 64; ++n) {
                const glm::ivec2 p = 8 * glm::ivec2(x, y) + glm::ivec2(n % 8, n / 8);
                std::int32_t* pixel = &sheet.pixels()[p.y * sheet.pitch() + channels * p.x];
                // Whole rows stay empty, too.
                if (p.y % 5 == 1) continue;
                for (int c = 0; c < channels; ++c) {
                    pixel[c] = std::int32_t(uniform(random) * ClassTable::kMax * Footprint::kOne);
                }
            }
            sheet.touch(glm::ivec2(x, y) - margin, ~std::uint64_t{0});
        }
    }
    sheet.settle();
    return sheet;
}

// The base plane of slices that are shifted so much along (v, u).
BasePlane planeOf(const SheetLayout& layout, glm::dvec2 d) {
    Factorization view;
    view.shiftPerSlice = {d.y, d.x};
    return BasePlane(view, layout.firstSlice, layout.firstVoxel, layout.resolution,
                     layout.offsetPixels);
}

double sheetAt(const Sheet& sheet, int x, int y, int c) {
    const glm::ivec2 size = sheet.layout().sizePixels;
    if (x < 0 || y < 0 || x >= size.x || y >= size.y) return 0;
    return double(sheet.row(y)[sheet.layout().channels * x + c]) * kScale;
}

// The sheet of a slice, read bilinearly where base plane pixel b falls on it.
double bilinearAt(const Sheet& sheet, glm::dvec2 d, int slice, glm::ivec2 b, int c) {
    // The box begins with slice 0.
    const glm::dvec2 p = glm::dvec2(b) - d * double(slice) + double(sheet.layout().marginPixels);
    const int x = int(std::floor(p.x));
    const int y = int(std::floor(p.y));
    const double fx = p.x - x;
    const double fy = p.y - y;
    return (1 - fx) * (1 - fy) * sheetAt(sheet, x, y, c) +
           fx * (1 - fy) * sheetAt(sheet, x + 1, y, c) +
           (1 - fx) * fy * sheetAt(sheet, x, y + 1, c) + fx * fy * sheetAt(sheet, x + 1, y + 1, c);
}

Layer compositeSlices(glm::dvec2 d, int channels, int first = 0, int count = 4,
                      float scale = kScale) {
    Layer layer(reachOf(planeOf(randomSheet(0).layout(), d), randomSheet(0).layout(), 0, 6),
                channels);
    Compositor compositor({glm::vec4(scale)});
    for (int slice = first; slice < first + count; ++slice) {
        const Sheet sheet = randomSheet(std::uint32_t(slice), channels);
        const Sheet* const sheets[] = {&sheet};
        compositor.composite(sheets, readingOf(planeOf(sheet.layout(), d), sheet.layout(), slice),
                             layer.box.min.y, layer.box.max.y, nullptr, layer);
    }
    return layer;
}

const glm::dvec2 kShifts[] = {{0, 0}, {1, -1}, {0.37, -0.81}, {-0.999, 0.001}, {0, 0.5}};

class LayerOfChannels : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Channels, LayerOfChannels, testing::Values(1, 4));

TEST_P(LayerOfChannels, CompositesBilinearReadingsInOrder) {
    const int channels = GetParam();
    for (const glm::dvec2 d : kShifts) {
        const Layer layer = compositeSlices(d, channels);
        std::vector<Sheet> sheets;
        for (std::uint32_t slice = 0; slice < 4; ++slice)
            sheets.push_back(randomSheet(slice, channels));
        for (int y = layer.box.min.y; y < layer.box.max.y; ++y) {
            for (int x = layer.box.min.x; x < layer.box.max.x; ++x) {
                double expected[4] = {};
                for (int slice = 0; slice < 4; ++slice) {
                    const double clear = 1 - expected[channels - 1];
                    for (int c = 0; c < channels; ++c) {
                        expected[c] += clear * bilinearAt(sheets[slice], d, slice, {x, y}, c);
                    }
                }
                for (int c = 0; c < channels; ++c) {
                    ASSERT_NEAR(layer.pixel({x, y})[c], expected[c], 1e-5)
                        << x << ' ' << y << ' ' << c;
                }
            }
        }
    }
}

// Two planes, the second of which is worth less and covers other tiles.
Layer compositePlanes(glm::dvec2 d, int channels) {
    Layer layer(reachOf(planeOf(randomSheet(0).layout(), d), randomSheet(0).layout(), 0, 6),
                channels);
    Compositor compositor({glm::vec4(kScale), glm::vec4(kScale / 64)});
    for (int slice = 0; slice < 3; ++slice) {
        const Sheet first = randomSheet(std::uint32_t(slice), channels);
        const Sheet second = randomSheet(std::uint32_t(slice + 50), channels);
        const Sheet* const sheets[] = {&first, &second};
        compositor.composite(sheets, readingOf(planeOf(first.layout(), d), first.layout(), slice),
                             layer.box.min.y, layer.box.max.y, nullptr, layer);
    }
    return layer;
}

TEST_P(LayerOfChannels, CompositesSumsOfPlanes) {
    const int channels = GetParam();
    for (const glm::dvec2 d : kShifts) {
        const Layer layer = compositePlanes(d, channels);
        std::vector<Sheet> sheets;
        for (std::uint32_t i : {0, 50, 1, 51, 2, 52}) sheets.push_back(randomSheet(i, channels));
        for (int y = layer.box.min.y; y < layer.box.max.y; ++y) {
            for (int x = layer.box.min.x; x < layer.box.max.x; ++x) {
                double expected[4] = {};
                for (int slice = 0; slice < 3; ++slice) {
                    const double clear = 1 - expected[channels - 1];
                    for (int c = 0; c < channels; ++c) {
                        const auto at = [&](int plane) {
                            return bilinearAt(sheets[std::size_t(2 * slice + plane)], d, slice,
                                              {x, y}, c);
                        };
                        expected[c] += clear * (at(0) + at(1) / 64);
                    }
                }
                for (int c = 0; c < channels; ++c) {
                    ASSERT_NEAR(layer.pixel({x, y})[c], expected[c], 1e-5)
                        << x << ' ' << y << ' ' << c;
                }
            }
        }
        for (const std::string& level : test::testedSimdLevels()) {
            setSimdLevel(level);
            EXPECT_EQ(compositePlanes(d, channels).values, layer.values) << level;
        }
        setSimdLevel("auto");
    }
}

// A plane of zeros changes no bit, wherever it is said to be full.
TEST_P(LayerOfChannels, PlanesOfZerosChangeNothing) {
    const int channels = GetParam();
    for (const glm::dvec2 d : kShifts) {
        Layer layer(reachOf(planeOf(randomSheet(0).layout(), d), randomSheet(0).layout(), 0, 6),
                    channels);
        Compositor compositor({glm::vec4(kScale), glm::vec4(kScale)});
        for (int slice = 0; slice < 4; ++slice) {
            const Sheet sheet = randomSheet(std::uint32_t(slice), channels);
            Sheet zeros(sheet.layout());
            for (int x = slice % 2; x < sheet.layout().blocks.x; x += 2)
                zeros.show({x, slice % 3}, ~std::uint64_t{0}, 0);
            const Sheet* const sheets[] = {slice == 2 ? &zeros : &sheet,
                                           slice == 2 ? &sheet : &zeros};
            compositor.composite(sheets,
                                 readingOf(planeOf(sheet.layout(), d), sheet.layout(), slice),
                                 layer.box.min.y, layer.box.max.y, nullptr, layer);
        }
        EXPECT_EQ(layer.values, compositeSlices(d, channels).values);
    }
}

TEST_P(LayerOfChannels, RowsAreZeroOutsideOfTheirSpans) {
    const Layer layer = compositeSlices({0.37, -0.81}, GetParam());
    for (int y = 0; y < layer.box.size().y; ++y) {
        const glm::ivec2 span = layer.spans[std::size_t(y)];
        for (int x = 0; x < layer.box.size().x; ++x) {
            if (x >= span.x && x < span.y) continue;
            for (int c = 0; c < GetParam(); ++c) {
                ASSERT_EQ(layer.pixel(layer.box.min + glm::ivec2(x, y))[c], 0);
            }
        }
    }
}

TEST_P(LayerOfChannels, SameBitsAtEverySimdLevel) {
    for (const glm::dvec2 d : kShifts) {
        const auto best = compositeSlices(d, GetParam()).values;
        for (const std::string& level : test::testedSimdLevels()) {
            setSimdLevel(level);
            EXPECT_EQ(compositeSlices(d, GetParam()).values, best) << level;
        }
        setSimdLevel("auto");
    }
}

// Rows have values in their spans alone until they are finished, whatever lay there before.
TEST(Layer, IsZeroWhereNothingHasBeenPut) {
    Layer layer = compositeSlices({0.37, -0.81}, 4);
    const PlaneBox box{{-3, 8}, {40, 19}};
    layer.setBox(box);
    EXPECT_EQ(layer.box.min, box.min);
    EXPECT_EQ(layer.values.size(), std::size_t(4 * 43 * 11));
    for (const glm::ivec2 span : layer.spans) EXPECT_GE(span.x, span.y);
    std::fill(layer.values.begin(), layer.values.end(), NAN);
    const auto expectZero = [&](int y, int first, int last) {
        for (float* value = layer.pixel({first, y});
             value != layer.pixel({first, y}) + 4 * (last - first); ++value)
            ASSERT_EQ(*value, 0) << y;
    };
    for (const auto& [y, first, last] :
         {std::array{10, 5, 9}, {10, 7, 8}, {10, -1, 6}, {10, 12, 40}, {12, -3, 1}, {12, 30, 31}}) {
        layer.extend(y, first, last);
        expectZero(y, first, last);
        layer.pixel({first, y})[3] = 0.5f;
        layer.extend(y, first, first + 1);
        EXPECT_EQ(layer.pixel({first, y})[3], 0.5f);
        layer.pixel({first, y})[3] = 0;
    }
    expectZero(10, -1, 40);
    expectZero(12, -3, 31);
    EXPECT_EQ(layer.spans[2], glm::ivec2(2, 43));
    EXPECT_EQ(layer.spans[4], glm::ivec2(0, 34));
    EXPECT_TRUE(std::isnan(layer.pixel({31, 12})[0]));
    layer.clearRest();
    for (int y = 8; y < 19; ++y) expectZero(y, -3, 40);
    EXPECT_EQ(layer.spans[2], glm::ivec2(2, 43));
}

// A layer full of random numbers, those of each row in a span of its own.
Layer randomLayer(const PlaneBox& box, int channels, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Layer layer(box, channels);
    for (int y = box.min.y; y < box.max.y; ++y) {
        const int first = box.min.x + int(random() % unsigned(box.size().x));
        const int last = first + int(random() % unsigned(box.max.x - first + 1));
        if (first == last) continue;
        layer.extend(y, first, last);
        for (int i = 0; i < channels * (last - first); ++i) {
            layer.pixel({first, y})[i] = uniform(random);
        }
    }
    return layer;
}

// A layer as it is while it is made: with anything outside of its spans.
Layer unfinished(Layer layer) {
    for (int y = layer.box.min.y; y < layer.box.max.y; ++y) {
        const glm::ivec2 span = layer.spans[std::size_t(y - layer.box.min.y)];
        float* row = layer.pixel({layer.box.min.x, y});
        for (int x = 0; x < layer.box.size().x; ++x) {
            if (x < span.x || x >= span.y)
                std::fill_n(row + layer.channels * x, layer.channels, NAN);
        }
    }
    return layer;
}

// In whatever order they are done: the same bits as folding from the front.
TEST(LayerFold, IsOverFromTheFront) {
    const PlaneBox all{{-4, -5}, {30, 70}};
    const PlaneBox boxes[] = {{{0, 0}, {9, 70}}, {{-4, 3}, {6, 12}}, {{2, -5}, {30, 20}}, all};
    constexpr std::size_t kFront = 4;
    const std::vector<std::vector<std::size_t>> orders = {
        {kFront, 0, 1, 2, 3}, {3, 2, 1, 0, kFront}, {1, 0, kFront, 3, 2}, {2, 0, 1, 3, kFront}};
    for (const int channels : {1, 4}) {
        for (const auto& order : orders) {
            for (const bool takeAllFirst : {false, true}) {
                Layer merged(all, channels);
                LayerFold fold(4, merged, all);
                std::size_t taken = takeAllFirst ? 4 : 0;
                if (takeAllFirst) {
                    for (const PlaneBox& box : boxes) fold.take(box);
                }
                for (const std::size_t i : order) {
                    if (i == kFront) {
                        // Nobody else writes to the front layer before it is finished.
                        for (const float value : merged.values) ASSERT_EQ(value, 0);
                        merged = randomLayer(all, channels, 99);
                        fold.addFront();
                        // What waits is merged at once as long as more is to come.
                        const bool waits = order[0] == 0 || order[1] == 0;
                        if (waits && taken > 0 && taken < 4) {
                            EXPECT_NE(merged.values, randomLayer(all, channels, 99).values);
                        }
                        continue;
                    }
                    ++taken;
                    const Layer empty =
                        takeAllFirst ? Layer(boxes[i], channels) : fold.take(boxes[i]);
                    for (const glm::ivec2 span : empty.spans) ASSERT_GE(span.x, span.y);
                    fold.add(i, unfinished(randomLayer(boxes[i], channels, std::uint32_t(i))));
                }
                for (int y = all.min.y; y < all.max.y; ++y) fold.finishRow(y);
                std::vector<Layer> layers = {randomLayer(all, channels, 99)};
                for (std::uint32_t i = 0; i < 4; ++i)
                    layers.push_back(randomLayer(boxes[i], channels, i));
                for (int y = all.min.y; y < all.max.y; ++y) {
                    for (int x = all.min.x; x < all.max.x; ++x) {
                        float expected[4] = {};
                        for (const Layer& layer : layers) {
                            const PlaneBox& box = layer.box;
                            if (x < box.min.x || x >= box.max.x || y < box.min.y || y >= box.max.y)
                                continue;
                            const float clear = 1 - expected[channels - 1];
                            for (int c = 0; c < channels; ++c)
                                expected[c] += clear * layer.pixel({x, y})[c];
                        }
                        for (int c = 0; c < channels; ++c)
                            ASSERT_EQ(merged.pixel({x, y})[c], expected[c]);
                    }
                }
            }
        }
    }
}

// Merging layers is the same as compositing on, but for rounding.
TEST(Layer, OverIsAssociativeWithinRounding) {
    const glm::dvec2 d(0.25, 0.5);
    Layer merged = compositeSlices(d, 4, 0, 3, kScale / 8);
    LayerFold halves(1, merged, merged.box);
    halves.addFront();
    halves.add(0, compositeSlices(d, 4, 3, 3, kScale / 8));
    for (int y = merged.box.min.y; y < merged.box.max.y; ++y) halves.finishRow(y);
    const Layer whole = compositeSlices(d, 4, 0, 6, kScale / 8);
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        // Six slices, each rounded a handful of times to 2^-24 of values below 1.
        ASSERT_NEAR(merged.values[i], whole.values[i], 6 * 6 * std::ldexp(1.0, -24));
    }
}

}  // namespace
}  // namespace deltasplat
