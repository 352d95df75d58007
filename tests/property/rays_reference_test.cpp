// SPDX-License-Identifier: Apache-2.0
// Sums, largest and smallest values and means along parallel lines of sight against a plain double
// loop that shares no code with the library.
#include <gtest/gtest.h>

#include <cmath>

#include "property/ray_scene.h"
#include "property/value_volume.h"
#include "support/changed_volume.h"

namespace deltasplat::test {
namespace {

std::vector<CodeBook> codeBooks() {
    std::vector<double> table;
    for (int i = 0; i < 256; ++i) table.push_back(-3 + 0.0001 * i * i);
    return {CodeBook::integer(), CodeBook::integer(-1000), CodeBook::linear(-2, 5, 8),
            CodeBook::ofTable(table), CodeBook::integer(-(std::int64_t{1} << 40))};
}

double largestOf(const std::vector<reference::Seen>& seen) {
    double largest = 0;
    for (const reference::Seen& one : seen) largest = std::max(largest, std::abs(one.integral));
    return largest;
}

TEST(RaysReference, LineIntegralsAreThoseOfTrilinearInterpolation) {
    for (const CodeBook& book : codeBooks()) {
        SCOPED_TRACE(book.name());
        Volume volume = randomVolume({{-5, 3, -9}, {12, 20, 6}}, 3, 0.4, {1, 1.25, 0.9});
        test::changed(volume)->codeBook = book;
        const reference::ValueVolume plain = plainVolume(volume);
        for (const glm::dvec3& direction : kDirections) {
            const TestView view = viewOf(volume, direction);
            const auto expected = parallelLines(plain, view.view(), 1);
            const Image image = render(volume, optionsOf(Mode::kXray, view)).image;
            const double limit = 3e-6 * largestOf(expected);
            ASSERT_GT(limit, 0);
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const float* rgba = &image.rgba[4 * i];
                ASSERT_NEAR(rgba[0], expected[i].integral, limit) << i;
                for (int c = 1; c < 4; ++c) ASSERT_EQ(rgba[c], rgba[0]);
            }
        }
    }
}

// A voxel by itself weighs as much as it does, wherever lines of sight go, and is nowhere else.
TEST(RaysReference, OneVoxelIsItself) {
    const Volume volume = makeVolume({{0, 0, 0}, {8, 8, 8}}, [](int x, int y, int z) {
        return x == 4 && y == 4 && z == 4 ? 1000 : kInactive;
    });
    const reference::ValueVolume plain = plainVolume(volume);
    for (const glm::dvec3& direction : kDirections) {
        TestView view = viewOf(volume, direction);
        view.size = {33, 33};
        for (const double pixel : {1.0, 0.13}) {
            view.pixelWorld = pixel;
            const Image image = render(volume, optionsOf(Mode::kXray, view)).image;
            const auto expected = parallelLines(plain, view.view(), 1);
            for (std::size_t i = 0; i < expected.size(); ++i)
                ASSERT_NEAR(image.rgba[4 * i], expected[i].integral, 2e-3) << i;
            const glm::dvec3 unit = glm::abs(glm::normalize(direction));
            if (std::max({unit.x, unit.y, unit.z}) < 1) continue;
            EXPECT_EQ(image.pixel(16, 16)[0], 1000);
        }
    }
}

// Where pixels' middles are voxels', a pixel is the plain sum of a column.
TEST(RaysReference, ColumnsAddUpToTheirSums) {
    const Volume volume = randomVolume({{-5, 3, -9}, {12, 21, 7}}, 9, 0.3);
    const reference::ValueVolume plain = plainVolume(volume);
    TestView view = viewOf(volume, {0, 0, -1});
    view.up = {0, 1, 0};
    view.pixelWorld = 1;
    view.size = {18, 19};
    const Image image = render(volume, optionsOf(Mode::kXray, view)).image;
    for (int y = 0; y < 19; ++y) {
        for (int x = 0; x < 18; ++x) {
            double sum = 0;
            for (int z = 0; z < plain.dims[2]; ++z) {
                const std::size_t n = (std::size_t(z) * 19 + std::size_t(18 - y)) * 18 + x;
                sum += plain.active[n] ? plain.values[n] : 0;
            }
            ASSERT_NEAR(image.pixel(x, y)[0], sum, 1e-6 * sum);
        }
    }
}

// A pixel that is larger than a voxel has the mean of what its square meets.
TEST(RaysReference, LargePixelsAreMeans) {
    const Volume volume = makeVolume({{0, 0, 0}, {39, 39, 39}}, [](int x, int y, int z) {
        return int(120 + 60 * std::sin(0.35 * x + 0.2 * y) + 50 * std::cos(0.3 * z - 0.15 * y));
    });
    const reference::ValueVolume plain = plainVolume(volume);
    for (const glm::dvec3 direction : {kDirections[0], kDirections[8], kDirections[9]}) {
        for (const double pixel : {1.3, 3.7}) {
            TestView view = viewOf(volume, direction);
            view.pixelWorld = pixel;
            view.size = {12, 12};
            const Image image = render(volume, optionsOf(Mode::kXray, view)).image;
            constexpr int kFine = 8;
            view.pixelWorld = pixel / kFine;
            view.size = kFine * view.size;
            const auto fine = parallelLines(plain, view.view(), 1);
            const double largest = largestOf(fine);
            double squares = 0;
            for (int y = 0; y < 12; ++y) {
                for (int x = 0; x < 12; ++x) {
                    double mean = 0;
                    for (int j = 0; j < kFine; ++j)
                        for (int i = 0; i < kFine; ++i)
                            mean += fine[std::size_t((kFine * y + j) * 12 * kFine + kFine * x + i)]
                                        .integral;
                    mean /= kFine * kFine;
                    const double off = (image.pixel(x, y)[0] - mean) / largest;
                    ASSERT_LE(std::abs(off), 0.03) << x << ' ' << y;
                    squares += off * off;
                }
            }
            EXPECT_LE(std::sqrt(squares / 144), 0.006);
        }
    }
}

// Compares pictures of values: places are read an eighth of a slice apart, so that a peak
// between two of these is a little too low.
void expectValues(Mode mode, double reference::Seen::*value, double sign) {
    for (const CodeBook& book : codeBooks()) {
        SCOPED_TRACE(book.name());
        // Thin enough that some pixels see nothing. Means of what is active change at once where a
        // voxel begins to count.
        const double emptyShare = mode == Mode::kMin ? 0 : 0.96;
        Volume volume = randomVolume({{-5, 3, -9}, {12, 20, 6}}, 4, emptyShare, {1, 1.25, 0.9});
        test::changed(volume)->codeBook = book;
        const reference::ValueVolume plain = plainVolume(volume);
        const double low = book.valueOf(Code(volume.valueMin()));
        const double high = book.valueOf(Code(volume.valueMax()));
        int met = 0;
        int apart = 0;
        for (const glm::dvec3& direction : kDirections) {
            const TestView view = viewOf(volume, direction);
            const auto expected = parallelLines(plain, view.view(), 16);
            const Image image = render(volume, optionsOf(mode, view)).image;
            const double rounding = 2e-6 * std::max(std::abs(low), std::abs(high)) + 1e-6;
            double squares = 0;
            int count = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const float* rgba = &image.rgba[4 * i];
                // Where a line touches a voxel's corner rounding decides whether it is met.
                apart += rgba[3] != float(expected[i].met);
                if (rgba[3] == 0 || !expected[i].met) continue;
                ++count;
                const double less =
                    sign * (std::clamp(expected[i].*value, low, high) - double(rgba[0]));
                if (sign != 0) {
                    ASSERT_GE(less, -0.05 * (high - low) - rounding) << i;
                    squares += less * less;
                } else {
                    ASSERT_NEAR(rgba[0], expected[i].*value,
                                5e-4 * std::max(std::abs(low), std::abs(high)))
                        << i;
                }
            }
            met += count;
            const double most = mode == Mode::kMin ? 0.03 : 0.01;
            EXPECT_LE(std::sqrt(squares / count), most * (high - low) + rounding);
        }
        EXPECT_GT(met, 1000);
        EXPECT_LE(apart, met / 20);
    }
}

TEST(RaysReference, LargestValuesAreThoseOfTrilinearInterpolation) {
    expectValues(Mode::kMip, &reference::Seen::highest, 1);
}

TEST(RaysReference, SmallestValuesAreThoseOfMeansOfWhatIsActive) {
    expectValues(Mode::kMin, &reference::Seen::lowest, -1);
}

TEST(RaysReference, MeansAreThoseOfWhatIsActive) {
    expectValues(Mode::kAverage, &reference::Seen::mean, 0);
}

// Nearer to a march in steps of an eighth of a voxel than one in steps of half a voxel is.
TEST(RaysReference, LargestValuesAreNearerToAFineMarchThanACoarseOneIs) {
    const Volume volume = randomVolume({{0, 0, 0}, {23, 23, 23}}, 6, 0.7);
    const reference::ValueVolume plain = plainVolume(volume);
    for (const glm::dvec3& direction : kDirections) {
        const TestView view = viewOf(volume, direction);
        const auto fine = marchedHighest(plain, view.view(), 0.125);
        const auto coarse = marchedHighest(plain, view.view(), 0.5);
        const Image image = render(volume, optionsOf(Mode::kMip, view)).image;
        double ours = 0, theirs = 0;
        for (std::size_t i = 0; i < fine.size(); ++i) {
            ours += std::pow(image.rgba[4 * i] - fine[i], 2);
            theirs += std::pow(coarse[i] - fine[i], 2);
        }
        EXPECT_LT(ours, theirs) << direction.x << ' ' << direction.y << ' ' << direction.z;
    }
}

}  // namespace
}  // namespace deltasplat::test
