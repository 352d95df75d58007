// SPDX-License-Identifier: Apache-2.0
// The quick way to codes finds those that CodeBook::codeOf finds, and the quick measure of errors
// the largest.
#include "volume/book_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace deltasplat {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

// Values of the table, halfway between them, next to both, and far beyond.
std::vector<double> valuesAround(const std::vector<double>& table) {
    std::vector<double> values{0.0, -0.0, kMost, -kMost, kDenormal, -kDenormal, 1e39, -1e39};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double middle = i + 1 < table.size() ? table[i] / 2 + table[i + 1] / 2 : table[i] * 2;
        for (const double value : {table[i], middle, table[i] + (middle - table[i]) / 3}) {
            for (const double one : {value, std::nextafter(value, kMost),
                                     std::nextafter(value, -kMost), double(float(value))})
                if (std::isfinite(one)) values.push_back(one);
        }
    }
    return values;
}

void expectTheCodesOf(const CodeBook& book, const std::vector<double>& values) {
    const BookEncoder encode(book);
    for (const double value : values)
        ASSERT_EQ(encode(value), book.codeOf(value)) << book.name() << ' ' << value;
}

// Ladders of random steps, some with a single rung, over many octaves.
CodeBook someLadders(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<CodeBook::Piece> pieces;
    double first = -std::exp2(std::uniform_real_distribution<>(-20, 20)(random));
    int rungs = 0;
    while (rungs < 20000) {
        const double step = std::exp2(std::uniform_real_distribution<>(-24, 8)(random));
        const int count = 1 + int(std::exp2(std::uniform_real_distribution<>(0, 12)(random)));
        pieces.push_back({first, step, count});
        first += step * (count + std::uniform_real_distribution<>(0, 3)(random));
        rungs += count;
    }
    return CodeBook::ofPieces(pieces);
}

TEST(BookEncoder, FindsTheCodesOfLadders) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const CodeBook book = someLadders(seed);
        expectTheCodesOf(book, valuesAround(*book.table));
    }
}

// In one stretch of the floats lie steps of every size, denormals, and numbers beyond the floats.
TEST(BookEncoder, FindsTheCodesOfUnevenSteps) {
    std::vector<CodeBook::Piece> pieces{{-kMost, 0, 1}, {-1e300, 1e295, 3}, {-1e-320, 1e-322, 40}};
    for (int i = 0; i < 40; ++i) pieces.push_back({1 + std::exp2(i - 50), 0, 1});
    pieces.push_back({2, 1e-9, 3000});
    pieces.push_back({2.001, 0x1p-12, 5});
    pieces.push_back({1e38, 1e37, 100});
    pieces.push_back({1e308, 1e306, 50});
    const CodeBook book = CodeBook::ofPieces(pieces);
    expectTheCodesOf(book, valuesAround(*book.table));
}

TEST(BookEncoder, FindsTheCodesOfOtherBooks) {
    std::vector<double> steps;
    for (int i = -400; i <= 400; ++i) steps.push_back(0.01 * i);
    expectTheCodesOf(CodeBook::linear(-3, 7), valuesAround(steps));
    expectTheCodesOf(CodeBook::integer(-400), valuesAround({-400, -3, 0, 7, 65135}));
    const std::vector<double> values{-4.5, 0.0, 1e-320, 3, 3.25, 1e300};
    expectTheCodesOf(CodeBook::ofTable(values), valuesAround(values));
    expectTheCodesOf(CodeBook::half(), {0.0, -0.0, 1, -1, 0x1p-24, -0x1p-24, 65504, -65504, 0.25});
    const auto relative = CodeBook::relative({-5, 1e6, 1e-6, CodeBook::Values::kFloat}, 0.002);
    ASSERT_TRUE(relative);
    expectTheCodesOf(*relative, valuesAround(*relative->table));
}

// codeOf takes zeros for one value; who wants values back does not.
TEST(BookEncoder, TellsZerosApartWhereATableDoes) {
    const BookEncoder encode(CodeBook::ofTable({-1, -0.0, 0.0}));
    EXPECT_EQ(encode(-0.0), 1);
    EXPECT_EQ(encode(0.0), 2);
}

TEST(ErrorMeter, FindsTheLargestErrors) {
    for (const CodeBook& book : {someLadders(3), CodeBook::linear(-3, 7, 12)}) {
        for (const double bulk : {0.0, 0.3}) {
            ErrorMeter meter(book, bulk);
            CodeError expected;
            std::mt19937 random(5);
            for (int part = 0; part < 3; ++part) {
                ErrorMeter::Part found(meter);
                for (int i = 0; i < 5000; ++i) {
                    const double value = std::uniform_real_distribution<>(-3, 7)(random);
                    const Code code = book.codeOf(value);
                    found.add(value, code);
                    const double off = std::fabs(value - book.valueOf(code));
                    expected.absolute = std::max(expected.absolute, off);
                    expected.relative =
                        std::max(expected.relative, off / std::max(std::fabs(value), bulk));
                }
                meter.add(found);
            }
            EXPECT_EQ(meter.error().absolute, expected.absolute);
            EXPECT_EQ(meter.error().relative, expected.relative);
        }
    }
}

// Nothing is a share of 0.
TEST(ErrorMeter, OfZeroAllIsOff) {
    const CodeBook book = CodeBook::ofPieces({{1, 1, 2}});
    ErrorMeter meter(book, 0);
    ErrorMeter::Part part(meter);
    part.add(1, 0);
    part.add(0, 0);
    meter.add(part);
    EXPECT_EQ(meter.error().absolute, 1);
    EXPECT_EQ(meter.error().relative, 1);
}

}  // namespace
}  // namespace deltasplat
