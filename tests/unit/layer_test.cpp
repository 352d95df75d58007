// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "deltasplat/simd.h"
#include "deltasplat/threads.h"

namespace deltasplat {
namespace {

constexpr IndexBox kBox{{0, -3, 5}, {30, 20, 30}};  // slice, u, v
constexpr float kScale = 1.0f / (65535.0f * Footprint::kOne);

// A sheet with random colours in some of its inner tiles and zeros elsewhere.
Sheet randomSheet(std::uint32_t seed, double share = 0.5) {
    Sheet sheet(layoutSheet(kBox, makeFootprint(0.4, {0, 0}, 1)));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const glm::ivec2 tiles = sheet.layout().tiles();
    for (int y = 1; y + 1 < tiles.y; ++y) {
        for (int x = 1; x + 1 < tiles.x; ++x) {
            if (uniform(random) > share) continue;
            for (int n = 0; n < 64; ++n) {
                const glm::ivec2 p = 8 * glm::ivec2(x, y) + glm::ivec2(n % 8, n / 8);
                std::int32_t* pixel =
                    &sheet.pixels()[4 * (p.y * sheet.layout().pitchPixels() + p.x)];
                for (int c = 0; c < 4; ++c) {
                    pixel[c] = std::int32_t(uniform(random) * 65535 * Footprint::kOne);
                }
            }
            sheet.touch(8 * glm::ivec2(x, y), 8 * glm::ivec2(x, y) + 7);
        }
    }
    sheet.settle();
    return sheet;
}

double sheetAt(const Sheet& sheet, int x, int y, int c) {
    const glm::ivec2 size = sheet.layout().sizePixels;
    if (x < 0 || y < 0 || x >= size.x || y >= size.y) return 0;
    return double(sheet.row(y)[4 * x + c]) * kScale;
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

std::vector<float> compositeSlices(glm::dvec2 d, bool frontToBack, const std::string& level) {
    setSimdLevel(level);
    Layer layer(reachOf(randomSheet(0).layout(), d, 0, 4));
    for (int slice = 0; slice < 4; ++slice) {
        const Sheet sheet = randomSheet(std::uint32_t(slice));
        compositeSheet(sheet, shiftOf(sheet.layout(), d, slice), glm::vec4(kScale), frontToBack,
                       layer);
    }
    setSimdLevel("auto");
    return layer.rgba;
}

const glm::dvec2 kShifts[] = {{0, 0}, {1, -1}, {0.37, -0.81}, {-0.999, 0.001}};

TEST(Layer, CompositesBilinearReadingsInOrder) {
    for (const glm::dvec2 d : kShifts) {
        for (const bool frontToBack : {true, false}) {
            Layer layer(reachOf(randomSheet(0).layout(), d, 0, 4));
            layer.rgba = compositeSlices(d, frontToBack, "auto");
            for (int y = layer.box.min.y; y < layer.box.max.y; ++y) {
                for (int x = layer.box.min.x; x < layer.box.max.x; ++x) {
                    double expected[4] = {};
                    for (int k = 0; k < 4; ++k) {
                        const int slice = frontToBack ? k : 3 - k;
                        const Sheet sheet = randomSheet(std::uint32_t(slice));
                        const double clear = 1 - expected[3];
                        for (int c = 0; c < 4; ++c) {
                            expected[c] += clear * bilinearAt(sheet, d, slice, {x, y}, c);
                        }
                    }
                    for (int c = 0; c < 4; ++c) {
                        ASSERT_NEAR(layer.pixel({x, y})[c], expected[c], 1e-5)
                            << x << ' ' << y << ' ' << c;
                    }
                }
                if (y > layer.box.min.y + 12)
                    y += 5;  // a sample of rows is enough, and much faster
            }
        }
    }
}

TEST(Layer, SameBitsAtEverySimdLevel) {
    for (const glm::dvec2 d : kShifts) {
        for (const bool frontToBack : {true, false}) {
            const auto best = compositeSlices(d, frontToBack, "auto");
            for (const std::string& level : simdLevels()) {
                EXPECT_EQ(compositeSlices(d, frontToBack, level), best) << level;
            }
        }
    }
}

TEST(Layer, MergingIsOverInTheGivenOrder) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<Layer> layers;
    for (const PlaneBox box :
         {PlaneBox{{0, 0}, {9, 7}}, PlaneBox{{-4, 3}, {6, 12}}, PlaneBox{{2, -5}, {5, 20}}}) {
        layers.emplace_back(box);
        for (float& value : layers.back().rgba) value = uniform(random);
    }
    const ThreadLimit limit(2);
    const Layer merged = mergeLayers(layers);
    EXPECT_EQ(merged.box.min, glm::ivec2(-4, -5));
    EXPECT_EQ(merged.box.max, glm::ivec2(9, 20));
    for (int y = -5; y < 20; ++y) {
        for (int x = -4; x < 9; ++x) {
            float expected[4] = {};
            for (const Layer& layer : layers) {
                if (x < layer.box.min.x || x >= layer.box.max.x || y < layer.box.min.y ||
                    y >= layer.box.max.y) {
                    continue;
                }
                const float clear = 1 - expected[3];
                for (int c = 0; c < 4; ++c) expected[c] += clear * layer.pixel({x, y})[c];
            }
            for (int c = 0; c < 4; ++c) EXPECT_EQ(merged.pixel({x, y})[c], expected[c]);
        }
    }
}

// Merging layers is the same as compositing on, but for rounding.
TEST(Layer, OverIsAssociativeWithinRounding) {
    const glm::dvec2 d(0.25, 0.5);
    const auto part = [&](int first, int count) {
        Layer layer(reachOf(randomSheet(0).layout(), d, 0, 6));
        for (int slice = first; slice < first + count; ++slice) {
            const Sheet sheet = randomSheet(std::uint32_t(slice));
            compositeSheet(sheet, shiftOf(sheet.layout(), d, slice), glm::vec4(kScale / 8), true,
                           layer);
        }
        return layer;
    };
    std::vector<Layer> halves;
    halves.push_back(part(0, 3));
    halves.push_back(part(3, 3));
    const Layer merged = mergeLayers(halves);
    const Layer whole = part(0, 6);
    for (std::size_t i = 0; i < whole.rgba.size(); ++i) {
        // Six slices, each rounded a handful of times to 2^-24 of values below 1.
        ASSERT_NEAR(merged.rgba[i], whole.rgba[i], 6 * 6 * std::ldexp(1.0, -24));
    }
}

}  // namespace
}  // namespace deltasplat
