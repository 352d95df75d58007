// SPDX-License-Identifier: Apache-2.0
#include "screen/halved_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "screen/filter_table.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

constexpr LatticeBox kAll{glm::ivec2(-1000), glm::ivec2(1000)};

std::pmr::memory_resource& memory() {
    return *std::pmr::get_default_resource();
}

// A raster of random values, in spans of its rows.
struct RandomRaster {
    glm::ivec2 min;
    glm::ivec2 size;
    int channels;
    std::vector<float> values;
    std::vector<glm::ivec2> spans;

    RandomRaster(glm::ivec2 first, glm::ivec2 extent, int channelCount, unsigned seed)
        : min(first),
          size(extent),
          channels(channelCount),
          values(std::size_t(channelCount) * extent.x * extent.y) {
        std::mt19937 random(seed);
        for (int y = 0; y < size.y; ++y) {
            const int begin = int(random() % unsigned(size.x));
            const int end = begin + int(random() % unsigned(size.x - begin + 1));
            spans.emplace_back(begin, end);
            for (int i = channels * (y * size.x + begin); i < channels * (y * size.x + end); ++i)
                values[std::size_t(i)] = float(random() % 1000) / 1000;
        }
    }
    Raster raster() const { return {min, size, values.data(), channels, glm::vec3(1), spans}; }
    double at(int x, int y, int channel) const {
        const glm::ivec2 p = glm::ivec2(x, y) - min;
        if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) return 0;
        return values[std::size_t(channels * (p.y * size.x + p.x) + channel)];
    }
};

// What a halved raster's pixel should be.
double plainPixel(const RandomRaster& whole, glm::bvec2 along, glm::ivec2 point, int channel) {
    constexpr double kShares[] = {0.125, 0.375, 0.375, 0.125};
    double sum = 0;
    for (int j = 0; j < (along.y ? 4 : 1); ++j) {
        for (int i = 0; i < (along.x ? 4 : 1); ++i) {
            sum += (along.x ? kShares[i] : 1) * (along.y ? kShares[j] : 1) *
                   whole.at(along.x ? 2 * point.x - 1 + i : point.x,
                            along.y ? 2 * point.y - 1 + j : point.y, channel);
        }
    }
    return sum;
}

// All of a halved raster's pixels, and a border of what lies outside.
std::vector<float> pixelsOf(const Raster& raster, glm::ivec2 first, glm::ivec2 last) {
    std::vector<float> pixels;
    for (int y = first.y; y < last.y; ++y) {
        for (int x = first.x; x < last.x; ++x) {
            const glm::ivec2 p = glm::ivec2(x, y) - raster.min;
            const bool isInside =
                p.x >= 0 && p.y >= 0 && p.x < raster.size.x && p.y < raster.size.y;
            for (int c = 0; c < raster.channels; ++c)
                pixels.push_back(isInside ? raster.row(p.y)[raster.channels * p.x + c] : 0);
        }
    }
    return pixels;
}

constexpr glm::bvec2 kAxes[] = {{true, false}, {false, true}, {true, true}};

TEST(HalvedRaster, IsOfEighthsOfFourPixelsAlongEachAxis) {
    for (const glm::ivec2 min : {glm::ivec2(-4, 6), glm::ivec2(-7, 3), glm::ivec2(0, -1)}) {
        for (const glm::ivec2 size : {glm::ivec2(41, 30), glm::ivec2(1, 1), glm::ivec2(2, 17)}) {
            for (const int channels : {1, 4}) {
                const RandomRaster whole(min, size, channels, 7);
                for (const glm::bvec2 along : kAxes) {
                    std::vector<float> ofFirstLevel;
                    test::atEveryLevel([&] {
                        const HalvedRaster halved(whole.raster(), along, kAll, memory());
                        const glm::ivec2 first = min - 40;
                        const glm::ivec2 last = min + size + 40;
                        const std::vector<float> pixels = pixelsOf(halved.raster(), first, last);
                        std::size_t i = 0;
                        for (int y = first.y; y < last.y; ++y) {
                            for (int x = first.x; x < last.x; ++x) {
                                for (int c = 0; c < channels; ++c) {
                                    ASSERT_NEAR(pixels[i++], plainPixel(whole, along, {x, y}, c),
                                                1e-6)
                                        << x << "," << y;
                                }
                            }
                        }
                        if (ofFirstLevel.empty()) ofFirstLevel = pixels;
                        EXPECT_EQ(pixels, ofFirstLevel);
                    });
                }
            }
        }
    }
}

TEST(HalvedRaster, SpansHoldAllThatIsNotZero) {
    const RandomRaster whole({-3, 5}, {60, 40}, 1, 11);
    for (const glm::bvec2 along : kAxes) {
        const HalvedRaster halved(whole.raster(), along, kAll, memory());
        const Raster& raster = halved.raster();
        int outside = 0;
        for (int y = 0; y < raster.size.y; ++y) {
            for (int x = 0; x < raster.size.x; ++x) {
                if (x >= raster.span(y).x && x < raster.span(y).y) continue;
                ASSERT_EQ(raster.row(y)[x], 0.0f);
                ++outside;
            }
        }
        EXPECT_GT(outside, 50);
    }
}

// Where a raster begins, and what else is wanted, changes no pixel.
TEST(HalvedRaster, APartHasTheSamePixels) {
    const RandomRaster whole({-5, 2}, {70, 50}, 4, 3);
    const LatticeBox wanted{{4, 5}, {19, 14}};
    for (const glm::bvec2 along : kAxes) {
        const HalvedRaster all(whole.raster(), along, kAll, memory());
        const HalvedRaster part(whole.raster(), along, wanted, memory());
        EXPECT_EQ(part.raster().min, all.raster().min);
        EXPECT_EQ(part.raster().size, all.raster().size);
        EXPECT_EQ(pixelsOf(part.raster(), wanted.min, wanted.max),
                  pixelsOf(all.raster(), wanted.min, wanted.max));
    }
}

// Nothing is made where nothing is wanted.
TEST(HalvedRaster, APartBesideItIsEmpty) {
    const RandomRaster whole({-5, 2}, {70, 50}, 4, 3);
    for (const glm::ivec2 first :
         {glm::ivec2(-900, 10), glm::ivec2(900, 10), glm::ivec2(5, -900), glm::ivec2(5, 900)}) {
        for (const glm::bvec2 along : kAxes) {
            const HalvedRaster part(whole.raster(), along, {first, first + 20}, memory());
            for (int y = 0; y < part.raster().size.y; ++y)
                EXPECT_EQ(part.raster().span(y), glm::ivec2(0));
        }
    }
}

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return 1.5 * x * x * x - 2.5 * x * x + 1;
    if (x < 2) return -0.5 * x * x * x + 2.5 * x * x - 4 * x + 2;
    return 0;
}

// Weights of a raster's points from -`reach` on, where a filter reads it halved so often.
std::vector<double> weightsOfWhole(const FilterTable& filter, std::uint32_t fraction, int halvings,
                                   int reach) {
    const int middle = reach;
    std::vector<double> weights(std::size_t(2 * reach));
    for (int tap = 0; tap < filter.taps(); ++tap)
        weights[std::size_t(middle + filter.firstTap(0) + tap)] = filter.weights(fraction)[tap];
    for (int i = 0; i < halvings; ++i) {
        std::vector<double> before(weights.size());
        for (int point = -reach / 2 + 1; point < reach / 2 - 1; ++point) {
            constexpr double kShares[] = {0.125, 0.375, 0.375, 0.125};
            for (int j = 0; j < 4; ++j)
                before[std::size_t(middle + 2 * point - 1 + j)] +=
                    kShares[j] * weights[std::size_t(middle + point)];
        }
        weights = before;
    }
    return weights;
}

// What is read of a halved raster stands for what the wide filter reads of the whole one.
TEST(HalvedFilter, ComesCloseToTheWideOne) {
    struct Case {
        double stretch;
        int halvings;
        double most;  // sum of differences
    };
    for (const Case& wide : {Case{3, 1, 0.155},
                             {3.6, 1, 0.08},
                             {4.5, 1, 0.045},
                             {5.9, 1, 0.02},
                             {6, 2, 0.135},
                             {9, 2, 0.033},
                             {12, 3, 0.13},
                             {40, 4, 0.02}}) {
        const FilterTable table(WarpFilter::kSharp, wide.stretch, wide.halvings);
        const int reach = 512;
        for (int step = 0; step <= 64; ++step) {
            const auto fraction = std::uint32_t(
                std::min(std::ldexp(step, 26), double(std::numeric_limits<std::uint32_t>::max())));
            const std::vector<double> weights =
                weightsOfWhole(table, fraction, wide.halvings, reach);
            double position = step / 64.0;
            for (int i = 0; i < wide.halvings; ++i) position = 2 * position + 0.5;
            std::vector<double> direct;
            double sum = 0;
            for (int i = -reach; i < reach; ++i) {
                direct.push_back(catmullRom((i - position) / wide.stretch));
                sum += direct.back();
            }
            double difference = 0;
            double total = 0;
            for (std::size_t i = 0; i < direct.size(); ++i) {
                difference += std::abs(weights[i] - direct[i] / sum);
                total += weights[i];
            }
            EXPECT_LT(difference, wide.most) << wide.stretch << " at " << position;
            EXPECT_NEAR(total, 1, 1e-6);
        }
    }
}

}  // namespace
}  // namespace deltasplat
