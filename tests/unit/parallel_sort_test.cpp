// SPDX-License-Identifier: Apache-2.0
#include "base/sorting.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "deltasplat/threads.h"

namespace deltasplat {
namespace {

std::vector<std::uint32_t> randomNumbers(std::size_t count, std::uint32_t most) {
    std::mt19937 random(7);
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t& number : numbers) number = random() % most;
    return numbers;
}

TEST(ParallelSort, SortsAsOneThreadDoes) {
    // About the sizes from which on there are two pieces, and the most; and pieces of other sizes.
    for (const std::size_t count : {0, 1, 2, 4095, 8191, 8192, 8193, 20000, 262144, 300001}) {
        for (const std::uint32_t most : {2u, 1000u, 0xFFFFFFFFu}) {
            std::vector<std::uint32_t> expected = randomNumbers(count, most);
            std::sort(expected.begin(), expected.end(), std::greater());
            for (const int threads : {1, 2, 5}) {
                const ThreadLimit limit(threads);
                std::vector<std::uint32_t> sorted = randomNumbers(count, most);
                parallelSort(sorted, std::greater());
                EXPECT_EQ(sorted, expected) << count << " below " << most;
            }
        }
    }
}

}  // namespace
}  // namespace deltasplat
