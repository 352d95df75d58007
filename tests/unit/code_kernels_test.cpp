// SPDX-License-Identifier: Apache-2.0
#include "volume/code_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "formats/delta/leaf_kernels.h"
#include "formats/raw/raw_kernels.h"
#include "support/simd_levels.h"
#include "volume/block_kernels.h"
#include "volume/code_counts.h"

namespace deltasplat {
namespace {

template <typename T>
void rangesWhereverEndsLie() {
    constexpr T kMost = std::numeric_limits<T>::max();
    constexpr T kUsual = kMost - kMost / 3;
    for (const std::size_t size : {1, 7, 8, 31, 32, 33, 64, 512}) {
        for (std::size_t place = 0; place < size; ++place) {
            std::vector<T> codes(size, kUsual);
            const std::span<const T> all(codes);
            EXPECT_EQ(rangeOfCodes(all), std::pair(Code{kUsual}, Code{kUsual}));
            codes[place] = 0;
            EXPECT_EQ(rangeOfCodes(all).first, 0) << size << ' ' << place;
            codes[place] = kMost;
            EXPECT_EQ(rangeOfCodes(all).second, kMost) << size << ' ' << place;
        }
    }
}

TEST(CodeKernels, rangeOfCodes) {
    test::atEveryLevel([] {
        rangesWhereverEndsLie<Code>();
        rangesWhereverEndsLie<std::uint8_t>();
    });
}

template <typename T>
void countsAsOneByOne(Code lowest) {
    std::mt19937 random(9);
    for (std::size_t numbers = 1; numbers <= std::min<std::size_t>(70, kCodeCount - lowest);
         ++numbers) {
        const auto highest = Code(lowest + numbers - 1);
        if (highest > std::numeric_limits<T>::max()) return;
        std::vector<T> codes(512);
        std::vector<std::uint32_t> expected(numbers);
        for (T& code : codes) {
            // The first and the last may be missing.
            const std::size_t n = random() % numbers;
            code = T(lowest + n);
            ++expected[n];
        }
        FewCounts counts;
        const std::size_t few = countFewCodes(std::span<const T>(codes), lowest, highest, counts);
        // Of the shortest vectors that there are.
        EXPECT_TRUE(few == numbers || numbers > 16 / sizeof(T));
        EXPECT_TRUE(few == 0 || numbers <= kMostFewCodes);
        if (few == 0) continue;
        ASSERT_EQ(few, numbers);
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), counts.begin())) << numbers;
    }
}

TEST(CodeKernels, countFewCodes) {
    test::atEveryLevel([] {
        for (const int lowest : {0, 100, 250}) countsAsOneByOne<std::uint8_t>(Code(lowest));
        for (const int lowest : {0, 255, 40000, 65500}) countsAsOneByOne<Code>(Code(lowest));
        // No whole vectors.
        FewCounts counts;
        const std::vector<Code> codes(509, Code{5});
        EXPECT_EQ(countFewCodes(std::span<const Code>(codes), 5, 6, counts), 0u);
    });
}

TEST(CodeKernels, countBits) {
    test::atEveryLevel([] {
        EXPECT_EQ(countBits(std::array<std::uint64_t, 3>{~std::uint64_t{0}, 0, 0x8000000000000001}),
                  66u);
        EXPECT_EQ(countBits({}), 0u);
    });
}

TEST(CodeKernels, countMasks) {
    using Masks = std::vector<std::uint64_t>;
    const auto expectCounts = [](const Masks& masks, const MaskCounts& expected) {
        const MaskCounts counts = countMasks(masks);
        EXPECT_EQ(counts.voxels, expected.voxels);
        EXPECT_EQ(counts.words, expected.words);
        EXPECT_EQ(counts.writes, expected.writes);
    };
    test::atEveryLevel([&] {
        expectCounts({}, {0, 0, 0});
        expectCounts({0}, {0, 0, 0});
        expectCounts({~std::uint64_t{0}}, {64, 1, 24});
        // A voxel in each corner; full rows of two masks and none of one; one voxel and four.
        expectCounts({0x8100000000000081}, {4, 1, 4});
        expectCounts({0x00FF000000000000, 0, 0xFF}, {16, 2, 6});
        expectCounts({0x0000000F00000001}, {5, 1, 5});
    });
}

// A block of rows that lie anywhere.
template <typename T>
void encodesAsOneByOne(RawType type) {
    constexpr std::size_t kRow = 11 * sizeof(T) + 1;
    constexpr std::size_t kSlice = 9 * kRow + 3;
    std::mt19937 random(5);
    std::vector<std::byte> bytes(8 * kSlice);
    for (std::byte& byte : bytes) byte = std::byte(random());
    // As long as what is read.
    bytes.resize(1 + 7 * kSlice + 7 * kRow + 8 * sizeof(T));
    const RawBlock block{bytes.data() + 1, kRow, kSlice};
    for (const Code offset : {Code{0}, Code{200}, Code(-32768)}) {
        std::array<Code, 512> codes;
        encodeWholeBlock(block, type, offset, codes.data());
        for (std::size_t n = 0; n < 512; ++n) {
            const std::size_t x = n / 64, y = n / 8 % 8, z = n % 8;
            T value;
            std::memcpy(&value, block.first + z * kSlice + y * kRow + x * sizeof(T), sizeof value);
            ASSERT_EQ(codes[n], Code(Code(value) - offset)) << x << ' ' << y << ' ' << z;
        }
    }
}

TEST(CodeKernels, encodeWholeBlock) {
    test::atEveryLevel([] {
        encodesAsOneByOne<std::uint8_t>(RawType::kUint8);
        encodesAsOneByOne<std::int8_t>(RawType::kInt8);
        encodesAsOneByOne<std::uint16_t>(RawType::kUint16);
        encodesAsOneByOne<std::int16_t>(RawType::kInt16);
    });
}

// Blocks of few codes and of many, whole and not.
TEST(CodeCounts, addBlocks) {
    std::mt19937 random(3);
    for (const int numbers : {1, 7, 3000}) {
        for (const glm::ivec3& size : {glm::ivec3(8), glm::ivec3(5, 8, 3), glm::ivec3(1)}) {
            std::array<Code, 512> codes;
            for (Code& code : codes) code = Code(40000 + random() % unsigned(numbers));
            std::vector<std::uint64_t> expected(kCodeCount);
            Code low = 65535, high = 0;
            for (int n = 0; n < 512; ++n) {
                if (n / 64 >= size.x || n / 8 % 8 >= size.y || n % 8 >= size.z) continue;
                const Code code = codes[std::size_t(n)];
                expected[code] += 2;
                low = std::min(low, code);
                high = std::max(high, code);
            }
            CodeCounts counts(2);
            for (const std::size_t worker : {0, 1})
                EXPECT_EQ(counts.addBlock(worker, size, codes), std::pair(low, high));
            EXPECT_EQ(counts.take(), expected);
        }
    }
}

TEST(CodeCounts, addUpBeyond32Bits) {
    CodeCounts counts(2);
    const std::array<Code, 7> codes{1, 1, 1, 1, 1, 65535, 0};
    for (const std::size_t worker : {0, 1, 0}) {
        counts.add(worker, codes);
        // What is counted one by one, and what is many.
        for (int i = 0; i < 5000; ++i) counts.add(worker, 1, 1 << 20);
        counts.add(worker, 2, std::uint64_t{1} << 40);
        counts.add(worker, codes);
    }
    const std::vector<std::uint64_t> sums = counts.take();
    EXPECT_EQ(sums[0], 6u);
    EXPECT_EQ(sums[1], 30u + 3 * (std::uint64_t{5000} << 20));
    EXPECT_EQ(sums[2], 3 * (std::uint64_t{1} << 40));
    EXPECT_EQ(sums[65535], 6u);
    EXPECT_EQ(sums.size(), std::size_t(kCodeCount));
}

// Returns what a slot is shown as, or nothing if the rules do not allow it.
std::optional<ShortSlot> shownAs(std::uint32_t slot, const SlotRules& rules) {
    if (slot == 0) return rules.rest;
    if (slot >= rules.lowest && slot <= rules.highest) return ShortSlot(slot);
    const bool isInactive =
        slot >= rules.firstInactive && slot < rules.firstInactive + rules.inactiveCount;
    return isInactive ? std::optional<ShortSlot>(0) : std::nullopt;
}

TEST(LeafKernels, shortenSlots) {
    const SlotRules values{1, 300, 65537, 0, 0};
    const SlotRules resting{1, 65534, 65537, 0, 9};
    const SlotRules halves{1025, 64512, 65537, 0, 0};
    const SlotRules inactive{1, 300, 65537, 4, 0};
    test::atEveryLevel([&] {
        for (const SlotRules& rules : {values, resting, halves, inactive}) {
            const std::uint32_t usual = rules.highest - 5;
            for (const std::uint32_t odd :
                 {0u, 1u, 299u, 300u, 301u, 1024u, 1025u, 64512u, 64513u, 65534u, 65535u, 65536u,
                  65537u, 65540u, 65541u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
                for (std::size_t n = 0; n < 64; n += 7) {
                    std::array<std::uint32_t, 64> slots;
                    slots.fill(usual);
                    slots[n] = odd;
                    std::array<ShortSlot, 64> out{};
                    const auto expected = shownAs(odd, rules);
                    ASSERT_EQ(shortenSlots(slots.data(), rules, out.data()), expected.has_value())
                        << odd;
                    if (!expected) continue;
                    for (std::size_t i = 0; i < 64; ++i)
                        ASSERT_EQ(out[i], i == n ? *expected : ShortSlot(usual)) << odd;
                }
            }
        }
    });
}

}  // namespace
}  // namespace deltasplat
