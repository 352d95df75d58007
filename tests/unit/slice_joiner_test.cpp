// SPDX-License-Identifier: Apache-2.0
#include "words/slice_joiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/simd.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

constexpr double kOpaque = std::numeric_limits<double>::infinity();

using SliceClasses = std::array<ClassIndex, 64>;

SliceClasses randomClasses(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    SliceClasses classes;
    for (ClassIndex& one : classes) one = ClassIndex(random() % 3 == 0 ? 0 : random() % count);
    return classes;
}

SliceClasses joined(const SliceJoiner& joiner, const std::vector<SliceClasses>& slices,
                    std::size_t slice = 0) {
    std::vector<const ClassIndex*> rows;
    for (const SliceClasses& slice : slices) rows.push_back(slice.data());
    SliceClasses out;
    LookCache cache;
    joiner.join(rows, 8, slice, out.data(), cache);
    return out;
}

SliceClasses joined(const SliceJoiner& joiner, const SliceClasses& first,
                    const SliceClasses& second) {
    return joined(joiner, std::vector{first, second});
}

TEST(SliceJoiner, numbersPairs) {
    const SliceClasses first = randomClasses(256, 1);
    const SliceClasses second = randomClasses(256, 2);
    const SliceClasses out = joined(SliceJoiner::ofPairs(256), first, second);
    for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(out[i], 256 * first[i] + second[i]);
}

// Nine decades, what is opaque, and what is not there.
std::vector<double> someExtinctions() {
    std::vector<double> extinctions = {0, kOpaque};
    for (double extinction = 3e-7; extinction < 2e2; extinction *= 1.07)
        extinctions.push_back(extinction);
    return extinctions;
}

TEST(SliceJoiner, roundsSumsToLevels) {
    const std::vector<double> extinctions = someExtinctions();
    const SliceJoiner joiner = SliceJoiner::ofSums(extinctions);
    const std::vector<double> levels = joiner.levels();
    EXPECT_LE(levels.size(), 65536u);
    EXPECT_EQ(levels[0], 0);
    EXPECT_EQ(levels.back(), kOpaque);
    for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_GT(levels[i], levels[i - 1]);
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const SliceClasses first = randomClasses(extinctions.size(), 2 * seed);
        const SliceClasses second = randomClasses(extinctions.size(), 2 * seed + 1);
        const SliceClasses out = joined(joiner, first, second);
        for (std::size_t i = 0; i < 64; ++i) {
            const double sum = extinctions[first[i]] + extinctions[second[i]];
            ASSERT_LT(out[i], levels.size());
            if (sum == 0 || std::isinf(sum)) {
                EXPECT_EQ(levels[out[i]], sum);
            } else {
                EXPECT_NEAR(levels[out[i]] / sum, 1, 0x1p-11 + 1e-6);
            }
        }
    }
}

TEST(SliceJoiner, addsUpManySlices) {
    const std::vector<double> extinctions = someExtinctions();
    for (const int count : {4, 8, 32}) {
        const SliceJoiner joiner = SliceJoiner::ofSums(extinctions, count);
        const std::vector<double> levels = joiner.levels();
        EXPECT_LE(levels.size(), 65536u);
        for (std::uint32_t seed = 0; seed < 30; ++seed) {
            std::vector<SliceClasses> slices;
            for (int i = 0; i < count; ++i)
                slices.push_back(randomClasses(extinctions.size(), 32 * seed + std::uint32_t(i)));
            // The most that there can be, and opaque.
            for (SliceClasses& slice : slices) slice[0] = ClassIndex(extinctions.size() - 1);
            slices[1][1] = 1;
            const SliceClasses out = joined(joiner, slices);
            for (std::size_t i = 0; i < 64; ++i) {
                double sum = 0;
                for (const SliceClasses& slice : slices) sum += extinctions[slice[i]];
                ASSERT_LT(out[i], levels.size());
                if (sum == 0 || std::isinf(sum)) {
                    EXPECT_EQ(levels[out[i]], sum);
                } else {
                    EXPECT_NEAR(levels[out[i]] / sum, 1, 0x1p-11 + 1e-6);
                }
            }
        }
    }
}

// Premultiplied, of six decades, opaque ones among them; colours beyond 1.
std::vector<glm::dvec4> someLights(std::size_t count) {
    std::vector<glm::dvec4> lights(1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    while (lights.size() < count) {
        const double alpha = lights.size() % 17 == 0 ? 1 : std::exp2(-20 * share(random));
        lights.emplace_back(alpha * 3 * share(random), alpha * share(random), 0, alpha);
    }
    return lights;
}

// What slices look like one behind the other, the nearest first.
glm::dvec4 composite(const std::vector<glm::dvec4>& lights) {
    glm::dvec4 sum(0.0);
    for (const glm::dvec4& light : lights) sum += (1 - sum.a) * light;
    return sum;
}

TEST(SliceJoiner, roundsLooks) {
    const std::vector<glm::dvec4> lights = someLights(40);
    for (const int count : {2, 4, 8, 32}) {
        for (const bool lastInFront : {false, true}) {
            const SliceJoiner joiner = SliceJoiner::ofLooks(lights, {count, lastInFront});
            std::vector<std::vector<SliceClasses>> all;
            std::vector<SliceClasses> outs;
            for (std::uint32_t seed = 0; seed < 20; ++seed) {
                std::vector<SliceClasses>& slices = all.emplace_back();
                for (int i = 0; i < count; ++i)
                    slices.push_back(randomClasses(lights.size(), 100 * seed + std::uint32_t(i)));
                // Nothing, and one class alone, once and more often.
                for (SliceClasses& slice : slices) slice[0] = slice[1] = slice[2] = 0;
                slices.back()[1] = slices.back()[2] = slices.front()[2] = 7;
                outs.push_back(joined(joiner, slices));
            }
            EXPECT_FALSE(joiner.looks()->hasTooMany());
            const std::vector<glm::dvec4> looks = joiner.looks()->looks();
            for (std::size_t n = 0; n < all.size(); ++n) {
                for (std::size_t i = 0; i < 64; ++i) {
                    std::vector<glm::dvec4> ofSlices;
                    for (const SliceClasses& slice : all[n]) ofSlices.push_back(lights[slice[i]]);
                    if (lastInFront) std::reverse(ofSlices.begin(), ofSlices.end());
                    const glm::dvec4 expected = composite(ofSlices);
                    ASSERT_LT(outs[n][i], looks.size());
                    const glm::dvec4& look = looks[outs[n][i]];
                    EXPECT_EQ(outs[n][i] > 0, expected.a > 0);
                    EXPECT_EQ(look.a > 0, expected.a > 0);
                    if (expected.a == 0) continue;
                    const bool isAlone = i == 1 || i == 2;
                    // 512 levels an octave, of opacity or of what gets through; 1023 of a root.
                    const double ofAlpha = isAlone ? 1e-12 : 0x1p-10 + 1e-6;
                    EXPECT_NEAR(look.a / expected.a, 1, ofAlpha) << i;
                    EXPECT_NEAR(1 - look.a, 1 - expected.a, 0x1p-9 * (1 - expected.a) + 1e-6);
                    // As far as floats can tell.
                    const double rest = 1 - expected.a;
                    EXPECT_TRUE(look.a < 1 ? rest > 0x1p-25 : rest < 0x1p-20) << expected.a;
                    for (int c = 0; c < 3; ++c) {
                        const double color = expected[c] / expected.a;
                        const double step = 2 * std::sqrt(3 * color) / 1023 + 3.0 / (1023 * 1023);
                        EXPECT_NEAR(look[c], color, isAlone ? 1e-12 : 1.05 * step) << i << ' ' << c;
                    }
                }
            }
        }
    }
}

// Of few levels neighbours take different ones, and their mean is what it is.
TEST(SliceJoiner, keepsTheMeanOfWhatIsEven) {
    std::vector<glm::dvec4> lights = {glm::dvec4(0)};
    for (int i = 1; i < 40; ++i) {
        const double alpha = 0.02 * i;
        lights.emplace_back(alpha * glm::dvec3(0.3, 1 - 0.02 * i, 0.025 * i), alpha);
    }
    for (int dropped = 1; dropped <= 6; ++dropped) {
        SliceJoiner joiner = SliceJoiner::ofLooks(lights, {2});
        for (int i = 0; i < dropped; ++i) joiner.looks() = joiner.looks()->coarser();
        const double step = std::exp2(dropped - LookRun::kMostBits);
        for (std::size_t n = 2; n < lights.size(); n += 5) {
            std::vector<SliceClasses> slices(2);
            slices[0].fill(ClassIndex(n));
            slices[1].fill(ClassIndex(n - 1));
            std::vector<SliceClasses> outs;
            for (std::size_t slice = 0; slice < 8; ++slice)
                outs.push_back(joined(joiner, slices, slice));
            const std::vector<glm::dvec4> looks = joiner.looks()->looks();
            glm::dvec4 mean(0.0);
            for (const SliceClasses& out : outs)
                for (const ClassIndex number : out) mean += looks[number] / 512.0;
            const glm::dvec4 expected = composite({lights[n], lights[n - 1]});
            EXPECT_NEAR(mean.a, expected.a, 0.02 * step + 0.3 * step * step);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c], expected[c] / expected.a, 0.04 * step + 0.3 * step * step);
        }
    }
}

// Of 256 classes and fewer, pairs are put behind each other: to the same.
TEST(SliceJoiner, joinsLooksOfPairsToTheSame) {
    const std::vector<glm::dvec4> all = someLights(257);
    const std::vector<glm::dvec4> some(all.begin(), all.end() - 1);
    for (const int count : {2, 8, 32}) {
        std::vector<SliceClasses> slices;
        for (int i = 0; i < count; ++i) slices.push_back(randomClasses(256, std::uint32_t(i)));
        slices[0][3] = slices[1][3] = 255;
        const SliceJoiner paired = SliceJoiner::ofLooks(some, {count});
        const SliceJoiner single = SliceJoiner::ofLooks(all, {count});
        const SliceClasses ofPairs = joined(paired, slices);
        const SliceClasses ofSingles = joined(single, slices);
        for (std::size_t i = 0; i < 64; ++i) {
            const glm::dvec4 a = paired.looks()->looks()[ofPairs[i]];
            const glm::dvec4 b = single.looks()->looks()[ofSingles[i]];
            // A level, where floats are rounded differently.
            EXPECT_NEAR(a.a, b.a, 0x1p-9 * std::min(a.a, 1 - a.a) + 1e-6);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 6.0 / 1023);
        }
    }
}

// Of more classes than can be told apart alone, they are rounded as well.
TEST(SliceJoiner, roundsLooksOfManyClasses) {
    const std::vector<glm::dvec4> lights = someLights(60000);
    const SliceJoiner joiner = SliceJoiner::ofLooks(lights, {8});
    std::vector<SliceClasses> slices(8);
    for (std::size_t i = 1; i < 64; ++i) slices[i % 8][i] = ClassIndex(900 * i);
    const SliceClasses out = joined(joiner, slices);
    const std::vector<glm::dvec4> looks = joiner.looks()->looks();
    EXPECT_EQ(out[0], 0);
    for (std::size_t i = 1; i < 64; ++i)
        EXPECT_NEAR(looks[out[i]].a / lights[900 * i].a, 1, 0x1p-9) << i;
}

// Rows of as many voxels as become eight, and as many rows.
std::vector<ClassIndex> wideClasses(std::size_t count, std::uint32_t seed, std::size_t within) {
    std::vector<ClassIndex> all;
    while (all.size() < 64 * within * within) {
        const SliceClasses some = randomClasses(count, seed + 1000 * std::uint32_t(all.size()));
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

SliceClasses joinedWide(const SliceJoiner& joiner, const std::vector<std::vector<ClassIndex>>& wide,
                        std::size_t within) {
    std::vector<const ClassIndex*> rows;
    for (const std::vector<ClassIndex>& slice : wide) rows.push_back(slice.data());
    SliceClasses out;
    LookCache cache;
    joiner.join(rows, 8 * within, 0, out.data(), cache);
    return out;
}

// Voxels beside each other look like the mean of what each is, all slices of it.
TEST(SliceJoiner, takesMeansOfVoxelsBesideEachOther) {
    for (const std::size_t classCount : {std::size_t{40}, std::size_t{300}}) {
        const std::vector<glm::dvec4> lights = someLights(classCount);
        for (const std::size_t within : {std::size_t{2}, std::size_t{4}}) {
            for (const bool lastInFront : {false, true}) {
                const SliceJoiner joiner = SliceJoiner::ofLooks(
                    lights, {.slices = 16, .lastInFront = lastInFront, .within = int(within)});
                std::vector<std::vector<ClassIndex>> wide;
                for (std::uint32_t i = 0; i < 16; ++i) {
                    wide.push_back(wideClasses(classCount, 17 * i + 3, within));
                    // In some, nothing; in one, a single voxel.
                    for (std::size_t n = 0; n < 8 * within * within; ++n) wide.back()[n] = 0;
                }
                wide[5][3 * within + 1] = 9;
                const SliceClasses out = joinedWide(joiner, wide, within);
                const std::vector<glm::dvec4> looks = joiner.looks()->looks();
                for (std::size_t u = 0; u < 8; ++u) {
                    for (std::size_t v = 0; v < 8; ++v) {
                        glm::dvec4 expected(0.0);
                        for (std::size_t i = 0; i < within * within; ++i) {
                            const std::size_t row = within * u + i / within;
                            const std::size_t place = 8 * within * row + within * v + i % within;
                            std::vector<glm::dvec4> ofSlices;
                            for (const auto& slice : wide) ofSlices.push_back(lights[slice[place]]);
                            if (lastInFront) std::reverse(ofSlices.begin(), ofSlices.end());
                            expected += composite(ofSlices) / double(within * within);
                        }
                        const ClassIndex number = out[8 * u + v];
                        EXPECT_EQ(number > 0, expected.a > 0) << u << ' ' << v;
                        if (expected.a == 0) continue;
                        EXPECT_TRUE(u > 0 || v == 3);
                        const glm::dvec4& look = looks[number];
                        EXPECT_NEAR(look.a / expected.a, 1, 0x1p-10 + 1e-6);
                        for (int c = 0; c < 3; ++c) {
                            const double color = expected[c] / expected.a;
                            const double step =
                                2 * std::sqrt(3 * color) / 1023 + 3.0 / (1023 * 1023);
                            EXPECT_NEAR(look[c], color, 1.05 * step);
                        }
                    }
                }
                for (const std::string& level : test::testedSimdLevels()) {
                    setSimdLevel(level);
                    EXPECT_EQ(joinedWide(joiner, wide, within), out) << level;
                }
                setSimdLevel("auto");
            }
        }
    }
}

TEST(SliceJoiner, saysWhereLooksAreTooMany) {
    const std::vector<glm::dvec4> lights = someLights(200);
    const SliceJoiner fine = SliceJoiner::ofLooks(lights, {8});
    SliceJoiner coarse = fine;
    while (coarse.looks()->run().bits > LookRun::kLeastBits)
        coarse.looks() = coarse.looks()->coarser();
    EXPECT_FALSE(coarse == fine);
    for (std::uint32_t seed = 0; seed < 4000; ++seed) {
        std::vector<SliceClasses> slices;
        for (std::uint32_t i = 0; i < 8; ++i)
            slices.push_back(randomClasses(lights.size(), 8 * seed + i));
        joined(fine, slices);
        joined(coarse, slices);
    }
    EXPECT_TRUE(fine.looks()->hasTooMany());
    EXPECT_FALSE(coarse.looks()->hasTooMany());
    coarse.looks()->beginSample();
    EXPECT_FALSE(coarse.looks()->hasTooMany());
    EXPECT_LE(coarse.looks()->looks().size(), 65536u);
}

// The most that there is has a level of its own, opaque or not.
TEST(SliceJoiner, hasALevelForTwiceTheLargest) {
    for (const double largest : {5.0, 0x1p-20, 0x1.fffffep9, 1e300}) {
        const std::vector<double> extinctions = {0, largest};
        const SliceJoiner joiner = SliceJoiner::ofSums(extinctions);
        SliceClasses both;
        both.fill(1);
        const SliceClasses out = joined(joiner, both, both);
        ASSERT_LT(out[0], joiner.levels().size());
        EXPECT_NEAR(joiner.levels()[out[0]] / (2 * largest), 1, 0x1p-11 + 1e-6);
    }
}

// What is too little for a level is not lost.
TEST(SliceJoiner, makesNothingEmpty) {
    const SliceJoiner joiner = SliceJoiner::ofSums({0, 1e-30, 1e-300, 5});
    const std::vector<double> levels = joiner.levels();
    EXPECT_LE(levels.size(), 65536u);
    for (const ClassIndex one : {1, 2}) {
        SliceClasses second{};
        second[6] = one;
        const SliceClasses out = joined(joiner, {}, second);
        EXPECT_EQ(out[6], 1);
        EXPECT_EQ(out[5], 0);
        EXPECT_LT(levels[out[6]], 5 * 0x1p-56);
    }
}

TEST(SliceJoiner, joinsWhatIsOpaqueAlone) {
    for (const std::vector<double>& extinctions :
         {std::vector<double>{0, kOpaque}, std::vector<double>{0}}) {
        const SliceJoiner joiner = SliceJoiner::ofSums(extinctions);
        SliceClasses second{};
        if (extinctions.size() > 1) second[0] = 1;
        const SliceClasses out = joined(joiner, {}, second);
        EXPECT_EQ(joiner.levels()[out[0]], extinctions.back());
        EXPECT_EQ(out[1], 0);
    }
}

// Extinctions of other volumes have the same levels, wherever these begin and end.
TEST(SliceJoiner, hasLevelsThatOthersHave) {
    const std::vector<double> some = SliceJoiner::ofSums({0, 0.01, 3}).levels();
    const std::vector<double> others = SliceJoiner::ofSums({0, 0.5, 7}).levels();
    std::size_t same = 0;
    for (const double level : some)
        same += level > 0 && std::find(others.begin(), others.end(), level) != others.end();
    EXPECT_GT(same, 3000u);  // 0.5 to 6, 1024 an octave
}

TEST(SliceJoiner, givesTheSameAtEverySimdLevel) {
    const std::vector<double> extinctions = someExtinctions();
    const std::vector<glm::dvec4> lights = someLights(250);
    const std::vector<glm::dvec4> moreLights = someLights(300);
    for (const int count : {2, 8, 32}) {
        std::vector<SliceClasses> slices;
        for (int i = 0; i < count; ++i) slices.push_back(randomClasses(250, 7 + std::uint32_t(i)));
        // Of looks, numbers are those of the first time that they came up.
        std::vector<SliceJoiner> joiners = {SliceJoiner::ofSums(extinctions, count),
                                            SliceJoiner::ofLooks(lights, {count}),
                                            SliceJoiner::ofLooks(lights, {count, true}),
                                            SliceJoiner::ofLooks(moreLights, {count}),
                                            SliceJoiner::ofLooks(lights, {count, false, 5}),
                                            SliceJoiner::ofLooks(moreLights, {count, true, 4})};
        if (count == 2) joiners.push_back(SliceJoiner::ofPairs(256));
        for (const SliceJoiner& joiner : joiners) {
            const SliceClasses expected = joined(joiner, slices, 3);
            for (const std::string& level : test::testedSimdLevels()) {
                setSimdLevel(level);
                EXPECT_EQ(joined(joiner, slices, 3), expected) << level;
            }
            setSimdLevel("auto");
        }
    }
}

}  // namespace
}  // namespace deltasplat
