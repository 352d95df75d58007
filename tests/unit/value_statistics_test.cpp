// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/value_statistics.h"
#include "support/changed_volume.h"

#include <gtest/gtest.h>

#include <numeric>

namespace deltasplat {
namespace {

// A volume of which only the values are known, as a raw file gives them.
Volume volumeOf(const CodeBook& book, const std::vector<std::uint64_t>& countOfCode) {
    VolumeData volume;
    volume.codeBook = book;
    volume.histogram = countOfCode;
    volume.histogram.resize(kCodeCount);
    for (std::size_t code = 0; code < countOfCode.size(); ++code) {
        if (countOfCode[code] == 0) continue;
        if (volume.empty()) volume.valueMin = book.valueOf(Code(code));
        volume.valueMax = book.valueOf(Code(code));
        volume.activeCount += countOfCode[code];
    }
    volume.box = {glm::ivec3(0), glm::ivec3(0)};
    return Volume(std::move(volume));
}

std::uint64_t sumOf(const std::vector<std::uint64_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TEST(GuessBackground, IsTheMostFrequentValueFromAFifthOn) {
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(), {10, 25, 15, 50})), 3.0);
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(-100), {30, 25, 15, 29})), -100.0);
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::linear(0, 65535), {0, 0, 7})), 2.0);
}

TEST(GuessBackground, NeedsItsShareExactly) {
    const std::vector<std::uint64_t> enough = {16, 16, 16, 16, 16, 20};
    const std::vector<std::uint64_t> less = {16, 16, 16, 16, 17, 19};
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(), enough)), 5.0);
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(), less)), std::nullopt);
}

TEST(GuessBackground, OfTwoAsFrequentIsTheSmaller) {
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(), {1, 40, 2, 40})), 1.0);
}

TEST(GuessBackground, IsTheBackgroundWhereThereIsOne) {
    Volume volume = volumeOf(CodeBook::integer(), {10, 90});
    test::changed(volume)->hasBackground = true;
    test::changed(volume)->background = -0.5;
    EXPECT_EQ(guessBackground(volume), -0.5);
}

TEST(GuessBackground, NothingHasNone) {
    EXPECT_EQ(guessBackground(volumeOf(CodeBook::integer(), {})), std::nullopt);
}

TEST(Histogram, BytesFillAllBinsAlike) {
    const Volume volume = volumeOf(CodeBook::integer(), std::vector<std::uint64_t>(256, 3));
    const ValueHistogram histogram = histogramOfValues(volume, 64);
    EXPECT_EQ(histogram.low, 0);
    EXPECT_EQ(histogram.high, 256);
    EXPECT_EQ(histogram.counts, std::vector<std::uint64_t>(64, 12));
}

TEST(Histogram, WholeNumbersGetBinsOfWholeWidth) {
    // 101 values: two a bin, the last value alone in its bin, nothing beyond.
    const Volume volume = volumeOf(CodeBook::integer(-7), std::vector<std::uint64_t>(101, 1));
    const ValueHistogram histogram = histogramOfValues(volume, 64);
    EXPECT_EQ(histogram.low, -7);
    EXPECT_EQ(histogram.high, -7 + 128);
    for (int i = 0; i < 64; ++i) EXPECT_EQ(histogram.counts[i], i < 50 ? 2u : i == 50 ? 1u : 0u);
}

TEST(Histogram, EveryBinOfAnyCountBeginsAtItsEdge) {
    // 1001 values in 7 bins of 143: no value slips into the bin before by rounding.
    const Volume volume = volumeOf(CodeBook::integer(3), std::vector<std::uint64_t>(1001, 1));
    EXPECT_EQ(histogramOfValues(volume, 7).counts, std::vector<std::uint64_t>(7, 143));
}

TEST(Histogram, OtherNumbersSpanTheirValues) {
    std::vector<std::uint64_t> counts(kCodeCount);
    counts[0] = 5;
    counts[16383] = 2;   // just below a quarter
    counts[16384] = 3;   // just above
    counts[65535] = 11;  // the upper edge belongs to the last bin
    const ValueHistogram histogram =
        histogramOfValues(volumeOf({CodeBook::Kind::kLinear, -1, 4.0 / 65535, nullptr}, counts), 4);
    EXPECT_EQ(histogram.low, -1);
    EXPECT_NEAR(histogram.high, 3, 1e-12);
    EXPECT_EQ(histogram.counts, (std::vector<std::uint64_t>{7, 3, 0, 11}));
}

TEST(Histogram, OneValueOnly) {
    const ValueHistogram level = histogramOfValues(volumeOf(CodeBook::linear(2.5, 2.5), {9}), 8);
    EXPECT_EQ(level.low, 2.5);
    EXPECT_EQ(level.high, 2.5);
    EXPECT_EQ(level.counts, (std::vector<std::uint64_t>{9, 0, 0, 0, 0, 0, 0, 0}));
    // Spans that doubles can hardly divide do no harm.
    const ValueHistogram tiny =
        histogramOfValues(volumeOf({CodeBook::Kind::kLinear, 0, 5e-324, nullptr}, {4, 5}), 64);
    EXPECT_EQ(sumOf(tiny.counts), 9u);
}

TEST(Histogram, OfNothingIsEmpty) {
    EXPECT_EQ(sumOf(histogramOfValues(volumeOf(CodeBook::half(), {}), 64).counts), 0u);
}

TEST(Percentile, IsTheFirstValueThatReachesIt) {
    const Volume volume = volumeOf(CodeBook::integer(100), {0, 1, 48, 1, 0, 49, 1});
    EXPECT_EQ(percentileValue(volume, 0), 101);
    EXPECT_EQ(percentileValue(volume, 1), 101);
    EXPECT_EQ(percentileValue(volume, 2), 102);
    EXPECT_EQ(percentileValue(volume, 49), 102);
    EXPECT_EQ(percentileValue(volume, 50), 103);
    EXPECT_EQ(percentileValue(volume, 51), 105);
    EXPECT_EQ(percentileValue(volume, 99), 105);
    EXPECT_EQ(percentileValue(volume, 100), 106);
}

TEST(Percentile, CountsOfHugeTilesDoNotOverflow) {
    const std::uint64_t huge = std::uint64_t{1} << 61;
    EXPECT_EQ(percentileCode(std::vector<std::uint64_t>{huge, huge}, 49), 0);
    EXPECT_EQ(percentileCode(std::vector<std::uint64_t>{huge, huge}, 51), 1);
}

TEST(Percentile, OfNothingIsTheBackground) {
    Volume volume = volumeOf(CodeBook::half(), {});
    test::changed(volume)->background = 0.25;
    EXPECT_EQ(percentileValue(volume, 50), 0.25);
    EXPECT_EQ(percentileCode({}, 50), 0);
}

}  // namespace
}  // namespace deltasplat
