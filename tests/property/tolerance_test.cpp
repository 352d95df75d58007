// SPDX-License-Identifier: Apache-2.0
// The bound of a relative tolerance, docs/method.md: no pixel of a picture is farther from the
// exact one.
#include <gtest/gtest.h>

#include <cmath>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "support/make_volume.h"

namespace deltasplat {
namespace {

// Sums of floats in another order: a few units of 2^-24 a slice.
constexpr double kRounding = 1e-5;

struct Difference {
    double color = 0;
    double alpha = 0;
};

Difference largestDifference(const Image& a, const Image& b) {
    Difference largest;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        double& largestOfKind = i % 4 == 3 ? largest.alpha : largest.color;
        largestOfKind = std::max(largestOfKind, std::abs(double{a.rgba[i]} - double{b.rgba[i]}));
    }
    return largest;
}

RenderOptions optionsOf(const glm::dvec3& direction, bool oneColor, double opacity) {
    RenderOptions options;
    options.camera.direction = direction;
    options.camera.up = glm::dvec3(0.1, 1, 0.2);
    options.camera.sizePixels = {96, 80};
    TransferFunction& function = options.optics.transferFunction;
    function.linearColors = true;
    function.colors = {{0, {1, 0.1, 0.5}}, {255, {0.2, 3, 0}}};
    if (oneColor) function.colors = {{0, {0.5, 2, 0}}};
    function.opacities = {{60, 0, 0.5, 0}, {255, opacity, 0.5, 0}};
    return options;
}

const glm::dvec3 kDirections[] = {{0, 0, -1}, {1, 0.3, -0.2}, {-0.4, 1, 0.9}};

TEST(ToleranceBound, HoldsOnRandomVolumes) {
    double loosest = 1e300;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const Volume volume = test::randomVolume({{-4, 0, 3}, {25, 30, 34}}, seed, 0.2);
        for (const glm::dvec3& direction : kDirections) {
            for (const bool oneColor : {false, true}) {
                for (const double opacity : {0.02, 0.4, 1.0}) {
                    RenderOptions options = optionsOf(direction, oneColor, opacity);
                    const RenderResult exact = render(volume, options);
                    EXPECT_EQ(exact.stats.errorBoundColor, 0);
                    for (const double t : {0.01, 0.1, 0.3}) {
                        options.splat.tolerance.relative = t;
                        const RenderResult held = render(volume, options);
                        const Difference difference = largestDifference(held.image, exact.image);
                        const RenderStats& stats = held.stats;
                        EXPECT_LE(difference.alpha, stats.errorBoundAlpha + kRounding);
                        EXPECT_LE(difference.color, stats.errorBoundColor + kRounding);
                        // What the filter of the warp may enlarge it by.
                        EXPECT_LE(stats.errorBoundAlpha, 1.7 * t);
                        if (t == 0.01) {
                            EXPECT_LE(stats.deltas, exact.stats.deltas);
                        } else {
                            EXPECT_LT(stats.deltas, exact.stats.deltas) << t;
                        }
                        loosest = std::min(loosest, stats.errorBoundAlpha / difference.alpha);
                    }
                }
            }
        }
    }
    // A bound that nothing comes near would prove little.
    EXPECT_LT(loosest, 8);
}

// A single opaque layer whose opacity is held at its limit: the bound is reached but for the
// filter.
TEST(ToleranceBound, IsReachedByOneSlice) {
    const Volume volume = test::makeVolume({{0, 0, 0}, {15, 15, 1}},
                                           [](int, int, int z) { return z == 0 ? 110 : 100; });
    RenderOptions options = optionsOf({0, 0, -1}, true, 1);
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {200, 0.2, 0.5, 0}};
    options.camera.sizePixels = {32, 32};
    options.splat.between = 0;
    const RenderResult exact = render(volume, options);
    options.splat.tolerance.relative = 0.11;
    const RenderResult held = render(volume, options);
    // Two slices of opacity 0.11 instead of 0.11 and 0.1: in the middle, away from what the warp's
    // filter does to edges.
    EXPECT_NEAR(held.image.pixel(16, 16)[3] - exact.image.pixel(16, 16)[3], 0.89 * (0.9 - 0.89),
                1e-4);
    EXPECT_LT(0.0089, held.stats.errorBoundAlpha);
    EXPECT_EQ(held.stats.deltas, 256u);
    EXPECT_EQ(exact.stats.deltas, 512u);
}

TEST(ToleranceBound, IsUnknownForATolerancesOfValuesAlone) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {20, 20, 20}}, 9);
    RenderOptions options = optionsOf({0, 0, -1}, false, 0.4);
    const RenderStats exact = render(volume, options).stats;
    options.splat.tolerance.value = 30;
    const RenderStats byValue = render(volume, options).stats;
    EXPECT_TRUE(std::isinf(byValue.errorBoundColor));
    EXPECT_TRUE(std::isinf(byValue.errorBoundAlpha));
    EXPECT_LT(byValue.deltas, exact.deltas);
    // Both together: neither may be exceeded.
    options.splat.tolerance.relative = 0.05;
    const RenderStats both = render(volume, options).stats;
    EXPECT_FALSE(std::isinf(both.errorBoundAlpha));
    EXPECT_GE(both.deltas, byValue.deltas);
    EXPECT_LE(both.deltas, exact.deltas);
}

TEST(ToleranceBound, EveryMethodHoldsTheSame) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {30, 25, 20}}, 11);
    RenderOptions options = optionsOf({1, 0.3, -0.2}, false, 0.4);
    options.splat.tolerance = {0.2, 12};
    options.splat.method = Method::kDelta;
    const Image expected = render(volume, options).image;
    for (const Method method : {Method::kAuto, Method::kSparse, Method::kTraditional}) {
        options.splat.method = method;
        EXPECT_EQ(render(volume, options).image.rgba, expected.rgba) << methodName(method);
    }
}

TEST(ToleranceBound, RefusesTolerancesOutOfRange) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {3, 3, 3}}, 1);
    for (const Tolerance tolerance : {Tolerance{-0.1, 0}, Tolerance{1, 0}, Tolerance{NAN, 0},
                                      Tolerance{0, -1}, Tolerance{0, INFINITY}}) {
        RenderOptions options = optionsOf({0, 0, -1}, false, 0.4);
        options.splat.tolerance = tolerance;
        try {
            render(volume, options);
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
        }
    }
}

}  // namespace
}  // namespace deltasplat
