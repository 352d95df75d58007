// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/code_book.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace deltasplat {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The value of a binary16 pattern straight from the format's definition.
double valueOfPattern(unsigned bits) {
    const int exponent = int(bits >> 10 & 0x1f);
    const double fraction = double(bits & 0x3ff);
    const double sign = (bits & 0x8000) != 0 ? -1 : 1;
    if (exponent == 31) return fraction == 0 ? sign * kInfinity : std::nan("");
    if (exponent == 0) return sign * std::ldexp(fraction, -24);
    return sign * std::ldexp(1024 + fraction, exponent - 25);
}

TEST(CodeBook, Names) {
    EXPECT_EQ(CodeBook::integer().name(), "integer");
    EXPECT_EQ(CodeBook::half().name(), "half");
    EXPECT_EQ(CodeBook::linear(0, 1).name(), "linear");
}

TEST(CodeBook, IntegerIsExactForEveryCodeAndOffset) {
    for (const std::int64_t offset : {0LL, -32768LL, -128LL, 4294901760LL, -(1LL << 40)}) {
        const CodeBook book = CodeBook::integer(offset);
        for (int code = 0; code < kCodeCount; ++code) {
            ASSERT_EQ(book.valueOf(Code(code)), double(offset + code));
            ASSERT_EQ(book.codeOf(double(offset + code)), code);
        }
    }
}

TEST(CodeBook, IntegerTakesTheNearestAndClamps) {
    const CodeBook book = CodeBook::integer(-10);
    EXPECT_EQ(book.codeOf(-9.4), 1);
    EXPECT_EQ(book.codeOf(-9.6), 0);
    EXPECT_EQ(book.codeOf(-1e30), 0);
    EXPECT_EQ(book.codeOf(1e30), 65535);
    EXPECT_EQ(book.codeOf(-kInfinity), 0);
    EXPECT_EQ(book.codeOf(kInfinity), 65535);
    EXPECT_EQ(book.codeOf(std::nan("")), 0);
}

TEST(CodeBook, EveryHalfPatternHasOneCode) {
    const CodeBook book = CodeBook::half();
    std::vector<bool> seen(kCodeCount, false);
    for (unsigned bits = 0; bits < unsigned(kCodeCount); ++bits) {
        const double value = valueOfPattern(bits);
        if (std::isnan(value)) continue;
        const Code code = book.codeOf(value);
        ASSERT_EQ(book.valueOf(code), value) << bits;
        ASSERT_EQ(std::signbit(book.valueOf(code)), std::signbit(value)) << bits;
        ASSERT_FALSE(seen[code]) << bits;
        seen[code] = true;
    }
}

TEST(CodeBook, HalfCodesAreInTheOrderOfValues) {
    const CodeBook book = CodeBook::half();
    double before = -kInfinity;
    int finite = 0;
    for (int code = 0; code < kCodeCount; ++code) {
        const double value = book.valueOf(Code(code));
        if (!std::isfinite(value)) continue;
        const bool zeros = before == 0 && value == 0;
        ASSERT_TRUE(value > before || zeros) << code;
        before = value;
        ++finite;
    }
    EXPECT_EQ(finite, 65536 - 2 * 1024);
    EXPECT_TRUE(std::isnan(book.valueOf(book.codeOf(std::nan("")))));
}

TEST(CodeBook, HalfTakesTheNearest) {
    const CodeBook book = CodeBook::half();
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-26, 16);
    for (int i = 0; i < 200000; ++i) {
        const double value = (i % 2 == 0 ? 1 : -1) * std::exp2(exponent(random));
        const Code code = book.codeOf(value);
        const double error = std::fabs(book.valueOf(code) - value);
        ASSERT_LE(error, std::fabs(book.valueOf(Code(code + 1)) - value)) << value;
        ASSERT_LE(error, std::fabs(book.valueOf(Code(code - 1)) - value)) << value;
    }
    EXPECT_EQ(book.valueOf(book.codeOf(1e9)), 65504);
    EXPECT_EQ(book.valueOf(book.codeOf(-1e9)), -65504);
    EXPECT_EQ(book.valueOf(book.codeOf(65519)), 65504);
}

// Just above the middle of two halves; rounding to float first loses the "just above".
TEST(CodeBook, HalfIsNotRoundedTwice) {
    const double middle = 1 + std::ldexp(1, -11);
    EXPECT_EQ(CodeBook::half().valueOf(CodeBook::half().codeOf(middle + std::ldexp(1, -40))),
              1 + std::ldexp(1, -10));
}

TEST(CodeBook, LinearErrorIsAtMostHalfAStep) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> share(0, 1);
    const double ranges[][2] = {{0, 1}, {-5, 3}, {1e-9, 1.5e-9}, {-3e38, 3e38}, {1e6, 1e6 + 1}};
    for (const auto& range : ranges) {
        const CodeBook book = CodeBook::linear(range[0], range[1]);
        const double size = std::max(std::fabs(range[0]), std::fabs(range[1]));
        EXPECT_LE(book.valueOf(0), range[0] + 1e-15 * size);
        EXPECT_GE(book.valueOf(65535), range[1] - 1e-15 * size);
        EXPECT_LE(book.step, (range[1] - range[0]) / 65534 * (1 + 1.0 / 128));
        if (range[0] <= 0) {
            EXPECT_EQ(book.valueOf(book.codeOf(0)), 0);
            for (const int code : {0, 1, 4711, 65534, 65535}) {
                const double value = book.valueOf(Code(code));
                EXPECT_EQ(double(float(value)), value);
            }
        }
        for (int i = 0; i < 20000; ++i) {
            const double value = range[0] + share(random) * (range[1] - range[0]);
            const double error = std::fabs(book.valueOf(book.codeOf(value)) - value);
            ASSERT_LE(error, book.step / 2 + 1e-15 * size);
        }
    }
}

TEST(CodeBook, LinearRoundTripsEveryCodeAndIncreases) {
    for (const CodeBook& book :
         {CodeBook::linear(0, 1), CodeBook::linear(-0.15, 0.15), CodeBook::linear(1, 1 + 1e-13),
          CodeBook::linear(0, 5e-324), CodeBook::linear(1e300, std::nextafter(1e300, 2e300))}) {
        double before = -kInfinity;
        for (int code = 0; code < kCodeCount; ++code) {
            const double value = book.valueOf(Code(code));
            ASSERT_EQ(book.codeOf(value), code);
            ASSERT_GT(value, before);
            before = value;
        }
    }
}

TEST(CodeBook, LinearOfOneValueHasThatValue) {
    const CodeBook book = CodeBook::linear(2.5, 2.5);
    EXPECT_EQ(book.codeOf(2.5), 0);
    EXPECT_EQ(book.codeOf(100), 0);
    EXPECT_EQ(book.valueOf(0), 2.5);
}

TEST(CodeBook, CodesStandForTheValuesThatGetThem) {
    const CodeBook linear = CodeBook::linear(0, 65535 * 0.5);
    EXPECT_TRUE(linear.standsFor(10, 5.0));
    EXPECT_TRUE(linear.standsFor(10, 5.2));
    EXPECT_FALSE(linear.standsFor(10, 5.3));
    EXPECT_TRUE(CodeBook::integer(-4).standsFor(1, -3));
    EXPECT_FALSE(CodeBook::integer(-4).standsFor(1, -3.01));
    const CodeBook half = CodeBook::half();
    EXPECT_TRUE(half.standsFor(half.codeOf(0.0), 0.0));
    EXPECT_FALSE(half.standsFor(half.codeOf(1.0), 1.0001));
}

// Values of codes are floats where the source's are, however far from 0 the range lies.
TEST(CodeBook, LinearCodesOfFloatsAreFloats) {
    std::mt19937_64 random(3);
    const double ranges[][2] = {{8388608, 8388608 + 98303},
                                {4294305.5, 4294305.5 + 40000},
                                {-1e9, -1e9 + 3e7},
                                {1e6, 1e6 + 1000},
                                {-3, 1e-3},
                                {0, 1.17e-38}};
    for (const auto& range : ranges) {
        for (const int bits : {8, 12, 16}) {
            SCOPED_TRACE(std::to_string(range[0]) + ", bits " + std::to_string(bits));
            const CodeBook book =
                CodeBook::linear(range[0], range[1], bits, CodeBook::Values::kFloat);
            for (int i = 0; i < 20000; ++i) {
                const double share = double(random() >> 11) * 0x1p-53;
                const auto source = float(range[0] + share * (range[1] - range[0]));
                const Code code = book.codeOf(double(source));
                ASSERT_LT(code, 1 << bits);
                const double value = book.valueOf(code);
                ASSERT_EQ(double(float(value)), value);
                ASSERT_LE(std::fabs(value - double(source)), book.step / 2);
            }
        }
    }
}

TEST(CodeBook, LinearCodesOfWholeNumbersAreWhole) {
    const CodeBook book = CodeBook::linear(-2147483648.0, 2147483647, 16, CodeBook::Values::kWhole);
    EXPECT_EQ(book.step, 65537);
    EXPECT_EQ(book.valueOf(0), -2147483648.0);
    EXPECT_GE(book.valueOf(65535), 2147483647.0);
    EXPECT_EQ(CodeBook::linear(7, 70, 16, CodeBook::Values::kWhole).step, 1);
}

}  // namespace
}  // namespace deltasplat
