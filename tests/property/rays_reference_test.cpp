// SPDX-License-Identifier: Apache-2.0
// X-ray and MIP against a plain renderer that shares no code with the library.
#include "reference/reference_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "property/ray_scene.h"

namespace deltasplat::test {
namespace {

std::vector<CodeBook> codeBooks() {
    std::vector<double> table;
    for (int i = 0; i < 256; ++i) table.push_back(-3 + 0.0001 * i * i);
    return {CodeBook::integer(), CodeBook::integer(-1000), CodeBook::linear(-2, 5, 8),
            CodeBook::ofTable(table), CodeBook::integer(-(std::int64_t{1} << 40))};
}

reference::ValueVolume plainVolume(const Volume& volume) {
    reference::ValueVolume plain;
    const glm::ivec3 dims = volume.box.dims();
    for (int k = 0; k < 3; ++k) {
        plain.first[k] = volume.box.min[k];
        plain.dims[k] = dims[k];
        for (int i = 0; i < 3; ++i) plain.axes[k][i] = volume.worldFromIndex[k][i];
        plain.origin[k] = volume.worldFromIndex[3][k];
    }
    for (int z = volume.box.min.z; z <= volume.box.max.z; ++z) {
        for (int y = volume.box.min.y; y <= volume.box.max.y; ++y) {
            for (int x = volume.box.min.x; x <= volume.box.max.x; ++x) {
                const openvdb::Coord at(x, y, z);
                plain.active.push_back(volume.codes->tree().isValueOn(at));
                plain.values.push_back(volume.codeBook.valueOf(volume.codes->tree().getValue(at)));
            }
        }
    }
    return plain;
}

double largestOf(const std::vector<reference::Seen>& seen) {
    double largest = 0;
    for (const reference::Seen& one : seen) largest = std::max(largest, std::abs(one.value));
    return largest;
}

// The warp reads its filter from a table of small steps: a share of the largest value that this
// costs where neighbours have nothing to do with each other.
constexpr double kWarpSteps = 1e-3;

// A footprint of sigma 0.2 is a single pixel but for 4e-6; wider ones are cut off where 0.2 % of
// their weight is left outside.
TEST(RaysReference, LineIntegralsAgreeWithThePlainReference) {
    for (const CodeBook& book : codeBooks()) {
        SCOPED_TRACE(book.name());
        Volume volume = randomVolume({{-5, 3, -9}, {12, 20, 6}}, 3, 0.4, {1, 1.25, 0.9});
        volume.codeBook = book;
        const reference::ValueVolume plain = plainVolume(volume);
        for (const glm::dvec3& direction : kDirections) {
            for (const double sigma : {0.2, 0.7}) {
                const TestView view = viewOf(volume, direction);
                const auto expected = lineIntegrals(plain, view.view(), sigma);
                const Image image = render(volume, optionsOf(Mode::kXray, view, sigma)).image;
                const double limit = (sigma == 0.2 ? kWarpSteps : 4e-3) * largestOf(expected);
                ASSERT_GT(limit, 0);
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    const float* rgba = &image.rgba[4 * i];
                    ASSERT_NEAR(rgba[0], expected[i].value, limit) << i;
                    for (int c = 1; c < 4; ++c) ASSERT_EQ(rgba[c], rgba[0]);
                }
            }
        }
    }
}

// Compares pictures of the largest or the smallest values.
void expectExtremes(Mode mode,
                    std::vector<reference::Seen> (*plainPicture)(const reference::ValueVolume&,
                                                                 const reference::View&)) {
    for (const CodeBook& book : codeBooks()) {
        SCOPED_TRACE(book.name());
        // Thin enough that some pixels see little.
        Volume volume = randomVolume({{-5, 3, -9}, {12, 20, 6}}, 4, 0.85, {1, 1.25, 0.9});
        volume.codeBook = book;
        const reference::ValueVolume plain = plainVolume(volume);
        const double low = book.valueOf(Code(volume.valueMin));
        const double high = book.valueOf(Code(volume.valueMax));
        int met = 0;
        int clear = 0;
        for (const glm::dvec3& direction : kDirections) {
            const TestView view = viewOf(volume, direction);
            const auto expected = plainPicture(plain, view.view());
            const Image image = render(volume, optionsOf(mode, view)).image;
            const double limit = kWarpSteps * std::max(largestOf(expected), high - low);
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const float* rgba = &image.rgba[4 * i];
                if (std::abs(expected[i].share - 0.5) < 1e-3) continue;
                const bool isMet = expected[i].share > 0.5;
                (isMet ? met : clear) += 1;
                ASSERT_EQ(rgba[3], isMet ? 1 : 0) << i;
                const double value = isMet ? std::clamp(expected[i].value, low, high) : 0;
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(rgba[c], value, limit) << i;
            }
        }
        EXPECT_GT(met, 1000);
        EXPECT_GT(clear, 1000);
    }
}

TEST(RaysReference, LargestValuesAgreeWithThePlainReference) {
    expectExtremes(Mode::kMip, reference::largestValues);
}

TEST(RaysReference, SmallestValuesAgreeWithThePlainReference) {
    expectExtremes(Mode::kMin, reference::smallestValues);
}

}  // namespace
}  // namespace deltasplat::test
