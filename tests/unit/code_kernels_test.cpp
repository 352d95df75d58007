// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/code_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "delta/block_kernels.h"
#include "ingest/codes/code_counts.h"
#include "ingest/raw/raw_kernels.h"
#include "support/simd_levels.h"

namespace deltasplat {
namespace {

TEST(CodeKernels, rangeOfCodesWhereverItsEndsLie) {
    test::atEveryLevel([] {
        for (const std::size_t size : {1, 7, 8, 31, 32, 33, 64, 512}) {
            for (std::size_t place = 0; place < size; ++place) {
                std::vector<Code> codes(size, 40000);
                EXPECT_EQ(rangeOfCodes(codes), std::pair(Code{40000}, Code{40000}));
                codes[place] = 0;
                EXPECT_EQ(rangeOfCodes(codes).first, 0) << size << ' ' << place;
                codes[place] = 65535;
                EXPECT_EQ(rangeOfCodes(codes).second, 65535) << size << ' ' << place;
            }
        }
    });
}

TEST(CodeKernels, countBits) {
    test::atEveryLevel([] {
        EXPECT_EQ(countBits(std::array<std::uint64_t, 3>{~std::uint64_t{0}, 0, 0x8000000000000001}),
                  66u);
        EXPECT_EQ(countBits({}), 0u);
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

// A block with one number other than the rest, wherever it lies.
template <typename T>
void rangesAsTheyAre(RawType type) {
    constexpr std::size_t kRow = 9 * sizeof(T) + 1;
    constexpr std::size_t kSlice = 8 * kRow + 3;
    const auto offset = Code(std::numeric_limits<T>::min());
    for (const T other : {std::numeric_limits<T>::min(), std::numeric_limits<T>::max(), T(5)}) {
        for (std::size_t n = 0; n < 512; n += 7) {
            std::vector<std::byte> bytes(1 + 7 * kSlice + 7 * kRow + 8 * sizeof(T));
            const RawBlock block{bytes.data() + 1, kRow, kSlice};
            for (std::size_t i = 0; i < 512; ++i) {
                const T value = i == n ? other : T(5);
                std::memcpy(&bytes[1 + i / 64 * kSlice + i / 8 % 8 * kRow + i % 8 * sizeof(T)],
                            &value, sizeof value);
            }
            const auto codeOf = [&](T value) { return Code(Code(value) - offset); };
            ASSERT_EQ(rangeOfWholeBlock(block, type, offset),
                      std::pair(codeOf(std::min(other, T(5))), codeOf(std::max(other, T(5)))))
                << n;
        }
    }
}

TEST(CodeKernels, rangeOfWholeBlock) {
    test::atEveryLevel([] {
        rangesAsTheyAre<std::uint8_t>(RawType::kUint8);
        rangesAsTheyAre<std::int8_t>(RawType::kInt8);
        rangesAsTheyAre<std::uint16_t>(RawType::kUint16);
        rangesAsTheyAre<std::int16_t>(RawType::kInt16);
    });
}

TEST(CodeKernels, encodeWholeBlock) {
    test::atEveryLevel([] {
        encodesAsOneByOne<std::uint8_t>(RawType::kUint8);
        encodesAsOneByOne<std::int8_t>(RawType::kInt8);
        encodesAsOneByOne<std::uint16_t>(RawType::kUint16);
        encodesAsOneByOne<std::int16_t>(RawType::kInt16);
    });
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

}  // namespace
}  // namespace deltasplat
