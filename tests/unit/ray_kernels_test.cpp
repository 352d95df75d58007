// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/simd.h"
#include "rays/blur_plane.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

using test::atEveryLevel;

std::vector<float> randomValues(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-2, 3);
    std::vector<float> values(count);
    for (float& value : values) value = uniform(random);
    return values;
}

TEST(RayKernels, BlocksAreReadInSliceOrder) {
    std::vector<Code> codes(512);
    std::iota(codes.begin(), codes.end(), Code(65535 - 511));
    std::vector<float> table(kCodeCount);
    for (int code = 0; code < kCodeCount; ++code) table[code] = std::sqrt(float(code));
    for (const bool direct : {false, true}) {
        const CodeValues values{table.data(), -1000, direct};
        for (int axis = 0; axis < 3; ++axis) {
            atEveryLevel([&] {
                const std::size_t rowStep = 24;
                const std::size_t sliceStep = 8 * rowStep + 3;
                std::vector<float> out(8 * sliceStep, -7);
                readBlockValues(codes.data(), axis, values, {&out[5], sliceStep, rowStep});
                for (int s = 0; s < 8; ++s) {
                    for (int u = 0; u < 8; ++u) {
                        for (int v = -1; v < 9; ++v) {
                            const float got = out[5 + s * sliceStep + u * rowStep + v];
                            if (v == -1 || v == 8) {
                                ASSERT_EQ(got, -7) << "beside the block";
                                continue;
                            }
                            const glm::ivec3 xyz = fromSliceOrder({s, u, v}, axis);
                            const Code code = codes[64 * xyz.x + 8 * xyz.y + xyz.z];
                            ASSERT_EQ(got, direct ? float(code - 1000) : table[code]);
                        }
                    }
                }
            });
        }
    }
}

TEST(RayKernels, SpansReadBilinearly) {
    for (const std::size_t pixels : {8, 24, 64}) {
        const auto row = randomValues(pixels + 1, 1);
        const auto nextRow = randomValues(pixels + 1, 2);
        const auto before = randomValues(pixels, 3);
        std::vector<std::uint8_t> mask(pixels / 8);
        for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = std::uint8_t(0x35 + 50 * i);
        for (const glm::vec2 fraction :
             {glm::vec2(0), glm::vec2(0.25f, 0.8f), glm::vec2(0, 0.5f)}) {
            atEveryLevel([&] {
                std::vector<float> sums = before, largest = before, met = before;
                std::vector<float> rest(pixels, 0.0f);
                const float* const at = row.data();
                const float* const below = nextRow.data();
                sumSpans({{at, below, sums.data(), rest.data(), pixels, nullptr}}, fraction);
                maxSpans({{at, below, largest.data(), nullptr, pixels, nullptr}}, fraction);
                maxSpans({{at, below, met.data(), nullptr, pixels, mask.data()}}, fraction);
                for (std::size_t i = 0; i < pixels; ++i) {
                    const double x = fraction.x, y = fraction.y;
                    const double read = (1 - y) * ((1 - x) * row[i] + x * row[i + 1]) +
                                        y * ((1 - x) * nextRow[i] + x * nextRow[i + 1]);
                    const float had = before[i];
                    ASSERT_NEAR(sums[i], had + read, 1e-6);
                    ASSERT_NEAR(largest[i], std::max<double>(had, read), 1e-6);
                    const bool isMet = mask[i / 8] >> (i % 8) & 1;
                    ASSERT_EQ(met[i], isMet ? largest[i] : had) << i;
                }
            });
        }
    }
}

// NaN stands for what is not there: the mean is that of the others, by their weights.
TEST(RayKernels, MissingNeighboursAreLeftOut) {
    constexpr std::size_t kPixels = 24;
    const float missing = std::numeric_limits<float>::quiet_NaN();
    auto row = randomValues(kPixels + 1, 1), nextRow = randomValues(kPixels + 1, 2);
    for (std::size_t i = 0; i <= kPixels; ++i) {
        if (i % 3 == 0) row[i] = missing;
        if (i % 5 < 2) nextRow[i] = missing;
    }
    for (const glm::vec2 fraction :
         {glm::vec2(0.25f, 0.8f), glm::vec2(0, 0.5f), glm::vec2(0.7f, 1)}) {
        const float x = fraction.x, y = fraction.y;
        std::vector<std::uint8_t> mask(kPixels / 8, 0);
        std::vector<double> expected(kPixels, -10);
        for (std::size_t i = 0; i < kPixels; ++i) {
            const float values[] = {row[i], row[i + 1], nextRow[i], nextRow[i + 1]};
            const double weights[] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
            double sum = 0, all = 0;
            for (int j = 0; j < 4; ++j) {
                if (std::isnan(values[j])) continue;
                sum += weights[j] * values[j];
                all += weights[j];
            }
            if (all == 0) continue;
            mask[i / 8] |= std::uint8_t(1 << i % 8);
            expected[i] = sum / all;
        }
        atEveryLevel([&] {
            std::vector<float> plane(kPixels, -10);
            maxSpans({{row.data(), nextRow.data(), plane.data(), nullptr, kPixels, mask.data()}},
                     fraction, {}, true);
            for (std::size_t i = 0; i < kPixels; ++i) ASSERT_NEAR(plane[i], expected[i], 2e-6) << i;
        });
    }
}

// With masks and without a pixel has the same bits where all is there.
TEST(RayKernels, WholeNeighboursAreReadAlike) {
    const auto row = randomValues(65, 1), nextRow = randomValues(65, 2);
    const std::vector<std::uint8_t> all(8, 0xFF);
    for (const glm::vec2 fraction :
         {glm::vec2(0.1f, 0.77f), glm::vec2(0.3f, 0), glm::vec2(0.3f, 1), glm::vec2(1, 0.2f)}) {
        atEveryLevel([&] {
            std::vector<float> plain(64, -10), masked(64, -10);
            maxSpans({{row.data(), nextRow.data(), plain.data(), nullptr, 64, nullptr}}, fraction);
            maxSpans({{row.data(), nextRow.data(), masked.data(), nullptr, 64, all.data()}},
                     fraction, {}, true);
            EXPECT_EQ(masked, plain);
        });
    }
}

TEST(RayKernels, EqualNeighboursAreReadExactly) {
    const std::vector<float> row(17, 0.1f);
    atEveryLevel([&] {
        std::vector<float> plane(16, -std::numeric_limits<float>::infinity());
        maxSpans({{row.data(), row.data(), plane.data(), nullptr, 16, nullptr}}, {0.3f, 0.77f});
        for (const float value : plane) ASSERT_EQ(value, 0.1f);
    });
}

// Sums of a million slices are off by no more than one rounding, and zeros change no bit.
TEST(SumSpans, KeepsWhatRoundingTakes) {
    const std::vector<float> row(17, 0.1f);
    const std::vector<float> zeros(17, 0.0f);
    atEveryLevel([&] {
        std::vector<float> plane(16, 0.0f), rest(16, 0.0f);
        constexpr int kSlices = 1'000'000;
        for (int i = 0; i < kSlices; ++i)
            sumSpans({{row.data(), row.data(), plane.data(), rest.data(), 16, nullptr}}, {0, 0});
        const double sum = double(0.1f) * kSlices;
        for (const float value : plane) ASSERT_NEAR(value, sum, 0x1p-23 * sum);
        const std::vector<float> before = plane, restBefore = rest;
        sumSpans({{zeros.data(), zeros.data(), plane.data(), rest.data(), 16, nullptr}}, {0, 0});
        ASSERT_EQ(plane, before);
        ASSERT_EQ(rest, restBefore);
    });
}

// One pixel becomes the footprint, wherever it is; weights add up to 1.
TEST(BlurPlane, StampsTheFootprint) {
    for (const int width : {1, 3, 4, 7}) {
        const Footprint footprint = makeFootprint(0.5, {0.4, -0.9}, 1, width);
        atEveryLevel([&] {
            RayPlane plane({{-3, 5}, {30, 29}});
            plane.row(17)[3 + 12] = 8;
            const RayPlane blurred = blurPlane(plane, footprint, 0.5f);
            double sum = 0;
            for (int y = 5; y < 29; ++y) {
                for (int x = -3; x < 30; ++x) {
                    const glm::ivec2 p = glm::ivec2(x - 12, y - 17) + footprint.reach();
                    const bool inside = p.x >= 0 && p.y >= 0 && p.x < width && p.y < width;
                    const double weight =
                        inside ? footprint.at(p.x, p.y) / double(Footprint::kOne) : 0;
                    ASSERT_NEAR(blurred.row(y)[x + 3], 4 * weight, 1e-6) << x << ' ' << y;
                    sum += blurred.row(y)[x + 3];
                }
            }
            EXPECT_NEAR(sum, 4, 1e-5);
        });
    }
}

}  // namespace
}  // namespace deltasplat
