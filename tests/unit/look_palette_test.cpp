// SPDX-License-Identifier: Apache-2.0
#include "words/look_palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

namespace deltasplat {
namespace {

TEST(LookPalette, numbersKeysOnceWhoeverAsks) {
    LookPalette palette(60000);
    constexpr std::uint64_t kKeys = 60000;
    std::vector<std::vector<std::uint32_t>> numbers(8, std::vector<std::uint32_t>(kKeys));
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < numbers.size(); ++t) {
        threads.emplace_back([&, t] {
            LookCache cache;
            for (std::uint64_t i = 0; i < kKeys; ++i) {
                const std::uint64_t n = (i * 7919 + t * 1000) % kKeys;
                numbers[t][n] = cache.numberOf((n + 1) << 20, palette);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_FALSE(palette.hasTooMany());
    for (const std::vector<std::uint32_t>& one : numbers) EXPECT_EQ(one, numbers[0]);
    std::vector<std::uint32_t> sorted = numbers[0];
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(kKeys);
    std::iota(all.begin(), all.end(), 1u);
    EXPECT_EQ(sorted, all);
    const std::vector<std::uint64_t> keys = palette.keys();
    ASSERT_EQ(keys.size(), kKeys);
    for (std::uint64_t n = 0; n < kKeys; ++n) EXPECT_EQ(keys[numbers[0][n] - 1], (n + 1) << 20);
}

TEST(LookPalette, hasNoMoreNumbersThanItMay) {
    LookPalette palette(3);
    for (const std::uint64_t key : {9, 8, 9, 7}) EXPECT_GT(palette.numberOf(key), 0u);
    EXPECT_FALSE(palette.hasTooMany());
    EXPECT_EQ(palette.numberOf(6), 0u);
    EXPECT_TRUE(palette.hasTooMany());
    EXPECT_EQ(palette.numberOf(9), 0u);
}

TEST(LookPalette, canBeLimited) {
    LookPalette palette(8);
    palette.limitTo(0.5);
    for (const std::uint64_t key : {1, 2, 3, 4}) EXPECT_GT(palette.numberOf(key), 0u);
    EXPECT_FALSE(palette.hasTooMany());
    palette.limitTo(1);
    EXPECT_GT(palette.numberOf(5), 0u);
    EXPECT_FALSE(palette.hasTooMany());
    palette.limitTo(0.5);
    EXPECT_TRUE(palette.hasTooMany());
    LookPalette other(8);
    other.limitTo(0.5);
    for (const std::uint64_t key : {1, 2, 3, 4, 5}) other.numberOf(key);
    EXPECT_TRUE(other.hasTooMany());
}

}  // namespace
}  // namespace deltasplat
