// SPDX-License-Identifier: Apache-2.0
// The renderer that judges the library is judged by closed forms first.
#include "reference/reference_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace reference {
namespace {

Volume filled(std::array<int, 3> first, std::array<int, 3> dims, const Vector& spacing,
              const Voxel& voxel) {
    Volume volume;
    volume.first = first;
    volume.dims = dims;
    volume.voxels.assign(std::size_t(dims[0]) * dims[1] * dims[2], voxel);
    for (int k = 0; k < 3; ++k) volume.axes[k][k] = spacing[k];
    return volume;
}

// Looks along -z, turned by an angle about +y, at a target.
View turned(double degrees, const Vector& target, int pixels, double pixelWorld) {
    const double angle = degrees * std::acos(-1.0) / 180;
    View view;
    view.direction = {-std::sin(angle), 0, -std::cos(angle)};
    view.right = {std::cos(angle), 0, -std::sin(angle)};
    view.up = {0, 1, 0};
    view.target = target;
    view.width = view.height = pixels;
    view.pixelWorld = pixelWorld;
    return view;
}

TEST(ReferenceRenderer, homogeneousSlabAttenuatesExponentially) {
    const double spacing = 0.5;
    const Volume slab =
        filled({-20, -20, 3}, {41, 41, 12}, {spacing, spacing, spacing}, {0.11, {0.25, 0.5, 1}});
    for (const double degrees : {0.0, 20.0, 44.0}) {
        const View view = turned(degrees, {0, 0, spacing * 8.5}, 2, 0.01);
        const double path = 12 * spacing / std::cos(degrees * std::acos(-1.0) / 180);
        const double alpha = 1 - std::exp(-0.11 * path);
        for (const Rgba& pixel : renderContinuous(slab, view, 0.6)) {
            EXPECT_NEAR(pixel[3], alpha, 1e-12);
            EXPECT_NEAR(pixel[0], 0.25 * alpha, 1e-12);
        }
        for (const Rgba& pixel : renderSampled(slab, view, 0.4, 2)) {
            EXPECT_NEAR(pixel[3], alpha, 1e-12);
            EXPECT_NEAR(pixel[1], 0.5 * alpha, 1e-12);
        }
    }
}

TEST(ReferenceRenderer, oneVoxelIsItsFootprint) {
    const double sigma = 0.7;
    const Volume voxel = filled({4, -5, 6}, {1, 1, 1}, {2, 2, 2}, {0.3, {1, 0.5, 0}});
    const int pixels = 9;
    const View view = turned(0, {8, -10, 12}, pixels, 0.5);
    const Picture picture = renderContinuous(voxel, view, sigma);
    const double alpha = 1 - std::exp(-0.3 * 2);
    for (int y = 0; y < pixels; ++y) {
        for (int x = 0; x < pixels; ++x) {
            // Pixels lie a quarter of a voxel apart, the middle one on the voxel.
            const double u = (x - 4) * 0.25;
            const double v = (4 - y) * 0.25;
            const auto g = [&](double a) { return std::exp(-a * a / (2 * sigma * sigma)); };
            double sumU = 0, sumV = 0;
            for (int i = -9; i <= 9; ++i) sumU += g(u - i), sumV += g(v - i);
            const double expected = alpha * g(u) * g(v) / (sumU * sumV);
            EXPECT_NEAR(picture[y * pixels + x][3], expected, 1e-6) << x << ' ' << y;
            EXPECT_NEAR(picture[y * pixels + x][1], expected / 2, 1e-6) << x << ' ' << y;
        }
    }
}

TEST(ReferenceRenderer, footprintIsTheRoundKernelSeenAlongTheRay) {
    // Seen at 45 degrees, a round kernel is as wide as ever on the screen: in slice coordinates its
    // variance along u doubles, and the screen halves it again.
    const Volume voxel = filled({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {0.3, {1, 1, 1}});
    const double sigma = 1.5;
    const Picture picture = renderContinuous(voxel, turned(45, {0, 0, 0}, 65, 0.125), sigma);
    const double middle = picture[32 * 65 + 32][3];
    for (const int offset : {-16, -8, 8, 16}) {
        const double expected = middle * std::exp(-std::pow(offset / 8.0 / sigma, 2) / 2);
        EXPECT_NEAR(picture[32 * 65 + 32 + offset][3], expected, 1e-4 * middle);
        EXPECT_NEAR(picture[(32 + offset) * 65 + 32][3], expected, 1e-4 * middle);
    }
}

TEST(ReferenceRenderer, whatIsNearerHidesWhatIsBehind) {
    const double opaque = std::numeric_limits<double>::infinity();
    Volume volume = filled({0, 0, 0}, {9, 9, 2}, {1, 1, 1}, {opaque, {1, 0, 0}});
    for (std::size_t i = 81; i < 162; ++i) volume.voxels[i].color = {0, 0, 1};
    // The camera of angle 0 is on the side of larger z.
    const Rgba front = renderContinuous(volume, turned(0, {4, 4, 1}, 1, 1), 0.5)[0];
    EXPECT_NEAR(front[2], 1, 1e-12);
    EXPECT_NEAR(front[0], 0, 1e-12);
    const Rgba back = renderContinuous(volume, turned(180, {4, 4, 1}, 1, 1), 0.5)[0];
    EXPECT_NEAR(back[0], 1, 1e-12);
    EXPECT_NEAR(back[2], 0, 1e-12);
}

TEST(ReferenceRenderer, picturesAreNotMirrored) {
    Volume volume = filled({0, 0, 0}, {9, 9, 1}, {1, 1, 1}, {0, {1, 1, 1}});
    volume.voxels[7 * 9 + 2].extinction = 1;  // x = 2, y = 7: on the left, at the top
    const Picture picture = renderContinuous(volume, turned(0, {4, 4, 0}, 9, 1), 0.3);
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            EXPECT_EQ(picture[y * 9 + x][3] > 0.5, x == 2 && y == 1) << x << ' ' << y;
        }
    }
}

TEST(ReferenceRenderer, samplingFinelyTendsToTheContinuousPicture) {
    Volume volume = filled({-2, 3, -4}, {5, 4, 6}, {1, 1.5, 1}, {0, {1, 1, 1}});
    for (std::size_t i = 0; i < volume.voxels.size(); ++i) {
        volume.voxels[i] = {0.2 * double(i * 7 % 5), {double(i % 2), 0.5, double(i % 3) / 2}};
    }
    const View view = turned(30, {0, 6.75, -1.5}, 60, 0.1);
    const Picture exact = renderContinuous(volume, view, 0.8);
    double last = 1;
    for (const int resolution : {1, 2, 4, 8}) {
        const Picture sampled = renderSampled(volume, view, 0.8, resolution);
        double worst = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            worst = std::max(worst, std::abs(exact[i][3] - sampled[i][3]));
        }
        EXPECT_LT(worst, last / 2) << resolution;
        last = worst;
    }
    EXPECT_LT(last, 2e-3);
}

}  // namespace
}  // namespace reference
