// SPDX-License-Identifier: Apache-2.0
#include "delta/slice_joiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

SliceClasses joined(const SliceJoiner& joiner, const SliceClasses& first,
                    const SliceClasses& second) {
    SliceClasses out;
    const std::array<const ClassIndex*, 2> slices = {first.data(), second.data()};
    joiner.join(slices, 8, out.data());
    return out;
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
    for (const SliceJoiner& joiner :
         {SliceJoiner::ofPairs(256), SliceJoiner::ofSums(extinctions)}) {
        const SliceClasses first = randomClasses(250, 7);
        const SliceClasses second = randomClasses(250, 8);
        const SliceClasses expected = joined(joiner, first, second);
        for (const std::string& level : test::testedSimdLevels()) {
            setSimdLevel(level);
            EXPECT_EQ(joined(joiner, first, second), expected) << level;
        }
        setSimdLevel("auto");
    }
}

}  // namespace
}  // namespace deltasplat
