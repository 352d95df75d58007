// SPDX-License-Identifier: Apache-2.0
#include "volume/float_kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/simd.h"
#include "support/simd_levels.h"
#include "volume/code_math.h"
#include "volume/value_census.h"

namespace deltasplat {
namespace {

using Floats = std::vector<float>;
using test::atEveryLevel;

// What a census of one value after the other says.
void expectFacts(const Floats& values) {
    ValueCensus census;
    for (const float value : values) census.add(value);
    atEveryLevel([&] {
        const FloatFacts facts = factsOf(values);
        EXPECT_TRUE(facts.isFinite);
        EXPECT_EQ(facts.isHalf, census.half);
        EXPECT_EQ(facts.isWhole, census.whole);
        EXPECT_EQ(double(facts.min), census.min);
        EXPECT_EQ(double(facts.max), census.max);
        EXPECT_EQ(double(facts.least), census.least);
        EXPECT_FALSE(std::signbit(facts.min) && facts.min == 0);
    });
}

Floats halvesOf(std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    Floats values;
    while (values.size() < count) {
        const double value = CodeBook::half().valueOf(Code(random() & 0xffff));
        if (std::isfinite(value)) values.push_back(float(value));
    }
    return values;
}

TEST(FloatKernels, OneValueSaysWhatItIs) {
    const float least = std::numeric_limits<float>::denorm_min();
    for (const float value :
         {0.0f,     -0.0f,        1.0f,         0.5f,     65504.0f,     65505.0f,
          65536.0f, 0x1p-24f,     0x1.8p-24f,   0x1p-25f, 0x1.ffcp-15f, 0x1.ffep-15f,
          0x1p-14f, 0x1.004p-14f, 0x1.002p-14f, 0x1p23f,  0x1p23f + 1,  0x1p24f,
          3e38f,    least,        2049.0f,      2048.5f,  1.0f / 3}) {
        for (const float sign : {1.0f, -1.0f}) {
            SCOPED_TRACE(sign * value);
            expectFacts({sign * value});
            // Wherever it stands among halves that are whole.
            for (const std::size_t place : {0, 3, 15, 16, 31, 40}) {
                Floats many(41, 7.0f);
                many[place] = sign * value;
                expectFacts(many);
            }
        }
    }
}

TEST(FloatKernels, ManyValues) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        Floats values = halvesOf(seed, 1 + seed * 13);
        expectFacts(values);
        std::mt19937 random(seed);
        values[random() % values.size()] =
            std::bit_cast<float>(std::uint32_t(random() & 0x3fffffff));
        expectFacts(values);
    }
}

TEST(FloatKernels, WhatIsNotFiniteIsFound) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float wrong : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(),
                              -std::numeric_limits<float>::signaling_NaN()}) {
        for (std::size_t size = 1; size < 40; ++size) {
            for (std::size_t place = 0; place < size; ++place) {
                Floats values(size, std::numeric_limits<float>::max());
                atEveryLevel([&] { EXPECT_TRUE(factsOf(values).isFinite); });
                values[place] = wrong;
                atEveryLevel([&] { EXPECT_FALSE(factsOf(values).isFinite); });
            }
        }
    }
}

TEST(FloatKernels, EveryHalfHasItsCode) {
    const CodeBook book = CodeBook::half();
    Floats values;
    std::vector<Code> codes;
    std::vector<std::uint16_t> bits;
    for (int code = 0; code < kCodeCount; ++code) {
        if (!std::isfinite(book.valueOf(Code(code)))) continue;
        values.push_back(float(book.valueOf(Code(code))));
        codes.push_back(Code(code));
        bits.push_back(halfBitsOfCode(Code(code)));
    }
    for (const std::size_t drop : {0, 1, 7}) {
        const std::size_t count = values.size() - drop;
        atEveryLevel([&] {
            std::vector<Code> got(count + 1, 4711);
            codesOfHalves({values.data(), count}, got.data());
            EXPECT_EQ(got.back(), 4711) << "behind the last";
            got.pop_back();
            EXPECT_EQ(got, std::vector<Code>(codes.begin(), codes.end() - std::ptrdiff_t(drop)));
            std::fill(got.begin(), got.end(), Code(0));
            EXPECT_TRUE(codesOfHalfBits({bits.data(), count}, got.data()));
            EXPECT_EQ(got, std::vector<Code>(codes.begin(), codes.end() - std::ptrdiff_t(drop)));
        });
    }
}

TEST(FloatKernels, HalfPatternsThatAreNotFiniteAreFound) {
    for (const std::uint16_t wrong : {0x7c00, 0xfc00, 0x7e00, 0xffff, 0x7c01}) {
        for (std::size_t place = 0; place < 45; ++place) {
            std::vector<std::uint16_t> bits(45, 0x7bff);
            bits[place] = wrong;
            std::vector<Code> codes(bits.size());
            atEveryLevel([&] { EXPECT_FALSE(codesOfHalfBits(bits, codes.data())); });
        }
    }
}

TEST(FloatKernels, WholeNumbersCountFromTheOffset) {
    for (const int offset : {0, -5, 1000, -65535, (1 << 24) - kCodeCount, -(1 << 24)}) {
        Floats values;
        std::vector<Code> codes;
        for (int code = 0; code < kCodeCount; ++code) {
            values.push_back(float(offset + code));
            codes.push_back(Code(code));
        }
        atEveryLevel([&] {
            std::vector<Code> got(values.size());
            codesOfWhole(values, float(offset), got.data());
            EXPECT_EQ(got, codes);
        });
    }
}

}  // namespace
}  // namespace deltasplat
