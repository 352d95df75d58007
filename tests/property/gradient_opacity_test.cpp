// SPDX-License-Identifier: Apache-2.0
// Opacity by how much values change: where they change evenly, that of a transfer function which is
// as much less opaque.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "deltasplat/render.h"
#include "support/error_of.h"
#include "support/make_volume.h"

namespace deltasplat::test {
namespace {

// Values grow by 5, -3 and 2 from voxel to voxel.
Volume evenSlope() {
    Volume volume = test::makeVolume(
        {{0, 0, 0}, {20, 24, 28}}, [](int x, int y, int z) { return 200 + 5 * x - 3 * y + 2 * z; });
    test::changed(volume)->worldFromIndex =
        glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3)) *
        glm::dmat4(glm::dmat3(glm::dvec3(0.5, 0, 0), glm::dvec3(0, 2, 0), glm::dvec3(0, 0, 1)));
    return volume;
}

// In data units per world unit.
const double kGradient = std::sqrt(10.0 * 10 + 1.5 * 1.5 + 2 * 2);

RenderOptions options(double opacity) {
    RenderOptions options;
    options.optics.transferFunction.colors = {{200, {0.2, 0.9, 0.4}}, {300, {0.9, 0.5, 0.1}}};
    options.optics.transferFunction.opacities = {{100, 0, 0.5, 0}, {350, opacity, 0.5, 0}};
    options.optics.unitDistance = 1.7;
    options.splat.resolution = 2;
    options.camera.sizePixels = {64, 64};
    options.camera.direction = glm::dvec3(-0.4, -1, -0.7);
    return options;
}

double difference(const RenderOptions& a, const RenderOptions& b) {
    const Volume volume = evenSlope();
    const Image one = render(volume, a).image;
    const Image other = render(volume, b).image;
    double most = 0;
    for (std::size_t i = 0; i < one.rgba.size(); ++i)
        most = std::max(most, double(std::abs(one.rgba[i] - other.rgba[i])));
    EXPECT_GT(one.pixel(32, 32)[3], 0.5);
    return most;
}

TEST(GradientOpacity, multipliesOpacityOverAUnitDistance) {
    for (const int between : {0, 1}) {
        for (const bool isLit : {false, true}) {
            RenderOptions plain = options(0.6 * 0.9);
            RenderOptions faded = options(0.9);
            plain.splat.between = faded.splat.between = between;
            // Three fifths, which looks can hold, half-way between two points.
            faded.optics.gradientOpacity = {{kGradient - 1, 0.5}, {kGradient + 1, 0.7}};
            const Shading shading;
            if (isLit) plain.optics.shading = faded.optics.shading = shading;
            EXPECT_LT(difference(plain, faded), 2e-3) << between << isLit;
        }
    }
}

TEST(GradientOpacity, goesOnAsItsEndsDo) {
    RenderOptions plain = options(0.6 * 0.9);
    RenderOptions faded = options(0.9);
    faded.optics.gradientOpacity = {{kGradient - 2, 1}, {kGradient - 1, 0.6}};
    EXPECT_LT(difference(plain, faded), 2e-3);
    faded.optics.gradientOpacity = {{kGradient + 1, 0.6}, {kGradient + 2, 1}};
    EXPECT_LT(difference(plain, faded), 2e-3);
}

TEST(GradientOpacity, ofOneChangesNothing) {
    RenderOptions faded = options(0.9);
    faded.optics.gradientOpacity = {{0, 1}};
    EXPECT_LT(difference(options(0.9), faded), 1e-4);
    // Nor does what opacity is not by: colours by place.
    RenderOptions placed = options(0.9);
    placed.optics.colorBy = ColorBy::kX;
    faded.optics.colorBy = ColorBy::kX;
    EXPECT_LT(difference(placed, faded), 1e-4);
}

TEST(GradientOpacity, clearsWhatDoesNotChange) {
    const Volume volume =
        test::makeVolume({{0, 0, 0}, {20, 24, 28}}, [](int, int, int) { return 300; });
    RenderOptions faded = options(0.9);
    faded.optics.gradientOpacity = {{0, 0}, {1, 1}};
    const RenderResult result = render(volume, faded);
    EXPECT_EQ(result.stats.visible, 0u);
    EXPECT_EQ(*std::max_element(result.image.rgba.begin(), result.image.rgba.end()), 0);
}

TEST(GradientOpacity, isExactUnderATolerance) {
    RenderOptions faded = options(0.9);
    faded.optics.gradientOpacity = {{0, 0.2}, {20, 0.7}};
    RenderOptions tolerant = faded;
    tolerant.splat.tolerance = {0.3, 0};
    EXPECT_EQ(difference(faded, tolerant), 0);
    EXPECT_EQ(render(evenSlope(), tolerant).stats.errorBoundColor, 0);
}

TEST(GradientOpacity, refusesPointsThatAreNone) {
    const auto messageOf = [&](std::vector<glm::dvec2> points) {
        RenderOptions faded = options(0.9);
        faded.optics.gradientOpacity = std::move(points);
        return errorOf([&] { render(evenSlope(), faded); });
    };
    EXPECT_EQ(messageOf({{2, 0}, {1, 1}}),
              "usage: `gradientOpacity`: got x = 1 behind 2; expected x not decreasing");
    EXPECT_EQ(messageOf({{-1, 0}}), "usage: `gradientOpacity`: got x = -1; expected a number >= 0");
    EXPECT_EQ(messageOf({{1, 1.5}}),
              "usage: `gradientOpacity`: got 1.5; expected a number within 0..1");
}

}  // namespace
}  // namespace deltasplat::test
