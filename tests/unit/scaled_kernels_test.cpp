// SPDX-License-Identifier: Apache-2.0
#include "composite/scaled_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/opacity_steps.h"
#include "deltasplat/simd.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

// Places where rounding could take a pixel too far, and others.
std::vector<double> starts() {
    std::vector<double> all = {0, -3.25, 5.5, 1e-300};
    for (const double whole : {1.0, 2.0, 17.0, 18.0, 31.0, 64.0, 127.0, 255.0}) {
        for (const double from : {whole - 32, whole}) {
            all.push_back(std::nextafter(from, -1e9));
            all.push_back(std::nextafter(std::nextafter(from, -1e9), -1e9));
            all.push_back(std::nextafter(from, 1e9));
            all.push_back(from - 1e-14);
        }
    }
    return all;
}

constexpr double kScales[] = {1, 1 - 0x1p-53, 1 - 1e-9, 0.99, 0.5, 0.03, 1 + 0x1p-52, 1.01, 2.5, 7};

// Kernels look a vector of pixels up in a vector of columns.
TEST(ScaledTaps, columnsOfPairsLieNoCloserThanPixels) {
    for (const double scale : kScales) {
        if (scale > 1) continue;
        for (const double start : starts()) {
            ScaledTaps taps;
            taps.set(start, scale, -7, 300, {0, 256});
            ASSERT_EQ(taps.first.size(), 300 + ScaledTaps::kSpare);
            for (std::size_t i = 1; i < taps.first.size(); ++i) {
                const int step = taps.first[i] - taps.first[i - 1];
                ASSERT_TRUE(step == 0 || step == 1) << start << ' ' << scale << ' ' << i;
            }
        }
    }
}

// Of a sheet that holds its own places, every pixel reads where it lies; a tent that is wider than
// two pixels, and no whole number of them, hardly more than a hundredth beside it.
TEST(ScaledTaps, readLinearSheets) {
    constexpr int kSize = 400;
    for (const double scale : kScales) {
        for (const double start : starts()) {
            const int pixels = int(300 / std::max(1.0, scale));
            ScaledTaps taps;
            taps.set(start, scale, 10, pixels, {0, kSize});
            for (int i = 0; i < pixels; ++i) {
                const double place = start + scale * (10 + i);
                if (place < taps.taps || place > kSize - taps.taps) continue;
                double read = 0;
                for (int tap = 0; tap < taps.taps; ++tap)
                    read +=
                        double(taps.of(std::size_t(i))[tap]) * (taps.first[std::size_t(i)] + tap);
                ASSERT_NEAR(read, place, scale > 1 ? 0.02 : 1e-4)
                    << start << ' ' << scale << ' ' << i;
            }
        }
    }
}

// What strips of a picture read, each a part of its own, are the same bits.
TEST(ScaledTaps, partsReadAsTheWholeDoes) {
    constexpr int kSize = 4000;
    constexpr int kFirst = 100;
    for (const double scale : {0.37, 0.9999, 1.0000001, 1.3, 2.71}) {
        for (const double start : {17.123456789, 311.9999999999, 1e-14}) {
            ScaledTaps whole;
            const int pixels = int(3000 / scale);
            whole.set(start, scale, kFirst, pixels, {0, kSize});
            for (const int origin : {640, 1024, 1736}) {
                const int size = 640;
                // Pixels of which all that they read lies in the part.
                int first = 0;
                while (whole.first[std::size_t(first)] <= origin) ++first;
                int last = first;
                while (last < pixels && whole.first[std::size_t(last)] + whole.taps < origin + size)
                    ++last;
                ScaledTaps part;
                part.set(start, scale, kFirst + first, last - first, {origin, size});
                ASSERT_EQ(part.taps, whole.taps);
                ASSERT_GT(last, first + 100);
                for (int i = first; i < last; ++i) {
                    const auto here = std::size_t(i - first);
                    ASSERT_EQ(part.first[here] + origin, whole.first[std::size_t(i)]);
                    for (int tap = 0; tap < whole.taps; ++tap)
                        ASSERT_EQ(part.of(here)[tap], whole.of(std::size_t(i))[tap])
                            << start << ' ' << scale << ' ' << origin << ' ' << i;
                }
            }
        }
    }
}

// Composites a random sheet, with two of its rows, onto a layer.
std::vector<float> composited(const ScaledTaps& taps, int pixels, int channels) {
    constexpr std::size_t kSize = 400;
    std::mt19937 random(3);
    std::vector<std::int32_t> sheet(std::size_t(channels) * 3 * kSize);
    for (std::int32_t& value : sheet) value = std::int32_t(random() % 32768);
    std::vector<float> layer(std::size_t(channels * pixels));
    for (float& value : layer) value = float(random() % 1000) / 1000;
    std::vector<float> steps;
    for (std::size_t i = 0; i < std::size_t(pixels) + kStepsSpare; ++i)
        steps.push_back(1 + float(i % 7) / 10);
    const glm::vec4 scale(1.0f / 40000);
    const float rows[] = {0.3f, 0.7f};
    const ScaledSlice slice{
        {sheet.data()}, std::size_t(channels) * kSize, {&scale, 1}, 2, taps.taps, channels};
    std::vector<ScaledRun> runs;
    for (int x = 0; x < pixels; x += 50) {
        runs.push_back(
            {std::size_t(channels * taps.first[std::size_t(x)]), rows, &taps.first[std::size_t(x)],
             taps.of(std::size_t(x)), taps.pairs.empty() ? nullptr : &taps.pairs[std::size_t(x)],
             std::min(50, pixels - x), &steps[std::size_t(x)], &layer[std::size_t(channels * x)]});
    }
    overScaled(slice, runs);
    return layer;
}

TEST(ScaledKernels, everySimdLevelGivesTheSameBits) {
    for (const double scale : kScales) {
        for (const double start : starts()) {
            const int pixels = int(300 / std::max(1.0, scale));
            ScaledTaps taps;
            taps.set(start, scale, 3, pixels, {0, 399});
            for (const int channels : {1, 4}) {
                setSimdLevel("auto");
                const auto expected = composited(taps, pixels, channels);
                for (const std::string& level : test::testedSimdLevels()) {
                    setSimdLevel(level);
                    ASSERT_EQ(composited(taps, pixels, channels), expected)
                        << level << ' ' << start << ' ' << scale;
                }
            }
        }
    }
    setSimdLevel("auto");
}

// Light and opacity of a slice that looks the same everywhere, for many lengths of the way through.
TEST(ScaledKernels, lightAndOpacityGrowWithSteps) {
    std::vector<float> steps = {0,      1e-6f, 0.3f,    0.8399f, 0.84f, 0.9f,
                                0.999f, 1,     1.0001f, 1.2f,    1.5f};
    for (const float step : {1.732f, 1.9999f, 2.0f, 2.0001f, 3.0f, 50.0f}) steps.push_back(step);
    const auto pixels = int(steps.size());
    steps.resize(steps.size() + kStepsSpare, 1);
    constexpr std::size_t kSize = 64;
    const std::vector<std::int32_t> sheet(4 * 3 * kSize, 1);
    ScaledTaps taps;
    taps.set(0, 1, 3, pixels, {0, kSize});
    const float rows[] = {0.25f, 0.75f};
    // Both sides of where the growth of opacity is a series.
    for (const double opacity : {0.0, 1e-31, 1e-12, 1e-4, 0.03, 0.1874, 0.1876, 0.5, 0.999}) {
        const glm::vec4 scale(glm::dvec4(opacity / 2, opacity / 4, 0, opacity));
        const ScaledSlice slice{{sheet.data()}, 4 * kSize, {&scale, 1}, 2, taps.taps, 4};
        std::vector<float> layer(std::size_t(4 * pixels));
        const ScaledRun run{0,      rows,         taps.first.data(), taps.of(0), taps.pairs.data(),
                            pixels, steps.data(), layer.data()};
        overScaled(slice, {&run, 1});
        for (int i = 0; i < pixels; ++i) {
            const double grown = -std::expm1(steps[std::size_t(i)] * std::log1p(-opacity));
            const float* color = &layer[std::size_t(4 * i)];
            EXPECT_NEAR(color[3], grown, 3e-6 * grown) << opacity << ' ' << steps[std::size_t(i)];
            EXPECT_NEAR(color[0], grown / 2, 3e-6 * grown) << opacity;
            EXPECT_NEAR(color[1], grown / 4, 3e-6 * grown) << opacity;
        }
    }
}

}  // namespace
}  // namespace deltasplat
