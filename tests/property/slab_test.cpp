// SPDX-License-Identifier: Apache-2.0
// Opacity is physical: a homogeneous slab of world thickness L is 1 - exp(-S L / cos(angle)),
// whatever its voxels are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "deltasplat/render.h"
#include "property/test_scene.h"

namespace deltasplat::test {
namespace {

constexpr double kOpacity = 0.25;  // over one unit distance, before it is scaled

// A slab perpendicular to z, `thickness` voxels deep and so wide that no ray through its middle
// leaves by its sides.
TestVolume makeSlab(const glm::dvec3& spacing, int thickness) {
    const glm::dvec2 width = 2.0 * thickness * spacing.z / glm::dvec2(spacing) + 20.0;
    TestVolume slab({0, 0, 0}, {int(width.x), 24, thickness});
    slab.worldFromIndex = spaced(spacing);
    std::fill(slab.values.begin(), slab.values.end(), 255.0f);
    return slab;
}

// Renders a few pixels at the slab's middle, seen `degrees` off its normal.
void expectSlab(const TestVolume& slab, const Volume& volume, double degrees,
                double alongExtinction, double resolution, double tolerance = 1e-3) {
    SCOPED_TRACE(std::to_string(degrees) + " degrees, resolution " + std::to_string(resolution));
    const double angle = degrees * std::acos(-1.0) / 180;
    const double thicknessWorld = slab.dims.z * slab.worldFromIndex[2][2];
    const double unitDistance = 3;

    TestView view;
    view.direction = {-std::sin(angle), 0, -std::cos(angle)};
    view.target = slab.world(0.5 * glm::dvec3(slab.dims - 1));
    view.size = {8, 8};
    view.pixelWorld = slab.worldFromIndex[0][0] / 4;
    RenderOptions options;
    options.camera = view.options();
    options.splat.resolution = resolution;
    options.optics.transferFunction = testTransferFunction(kOpacity);
    options.optics.unitDistance = unitDistance;

    // Extinction S is chosen for the thickness, so that every slab is as dense as the next.
    const double extinction = alongExtinction / thicknessWorld;
    options.optics.extinctionScale = extinction / (-std::log(1 - kOpacity) / unitDistance);
    const double expected = 1 - std::exp(-extinction * thicknessWorld / std::cos(angle));
    const RenderResult result = render(volume, options);
    for (int i = 0; i < 64; ++i) {
        ASSERT_NEAR(result.image.rgba[4 * i + 3], expected, tolerance) << "pixel " << i;
        ASSERT_NEAR(result.image.rgba[4 * i + 0], expected, tolerance) << "pixel " << i;
        ASSERT_NEAR(result.image.rgba[4 * i + 2], expected / 4, tolerance) << "pixel " << i;
    }
}

TEST(Slab, opacityDoesNotDependOnTheVoxelSize) {
    const struct {
        double voxelSize;
        int thickness;
    } cases[] = {{0.1, 70}, {1, 7}, {7, 1}};  // each 7 world units thick
    for (const auto& c : cases) {
        SCOPED_TRACE(c.voxelSize);
        const glm::dvec3 spacing(c.voxelSize);
        const TestVolume slab = makeSlab(spacing, c.thickness);
        const Volume volume = throughRaw(slab, spacing);
        for (const double degrees : {0.0, 20.0, 44.0}) {
            for (const double resolution : {1.0, 2.0})
                expectSlab(slab, volume, degrees, 0.8, resolution);
        }
    }
}

TEST(Slab, opacityDoesNotDependOnTheSpacing) {
    for (const glm::dvec3 spacing : {glm::dvec3(4, 1, 1), glm::dvec3(1, 4, 1)}) {
        const TestVolume slab = makeSlab(spacing, 28);
        const Volume volume = throughRaw(slab, spacing);
        for (const double degrees : {0.0, 20.0, 44.0}) {
            for (const double resolution : {1.0, 2.0})
                expectSlab(slab, volume, degrees, 0.8, resolution);
        }
    }
}

// Voxels four times as deep as wide: already at 20 degrees the line of sight crosses more slices
// along x than along z, and enters and leaves the slab by blurred faces.
TEST(Slab, opacityIsRightWhereSlicesRunAcrossTheSlab) {
    const glm::dvec3 spacing(1, 1, 4);
    const TestVolume slab = makeSlab(spacing, 32);
    const Volume volume = throughRaw(slab, spacing);
    for (const double degrees : {0.0, 20.0, 44.0}) {
        for (const int resolution : {1, 2}) expectSlab(slab, volume, degrees, 0.8, resolution);
    }
}

// The same where each slice hides much: voxels that are half seen twice hide a little less than one
// seen whole (docs/method.md, and the reference renderer, say so too).
TEST(Slab, thinDenseSlabAcrossSlicesMissesByWhatTheMethodMisses) {
    const glm::dvec3 spacing(1, 1, 4);
    const TestVolume slab = makeSlab(spacing, 7);
    const Volume volume = throughRaw(slab, spacing);
    for (const double degrees : {20.0, 44.0}) {
        for (const int resolution : {1, 2}) {
            expectSlab(slab, volume, degrees, 0.8, resolution, 4e-3);
        }
    }
}

TEST(Slab, thinFogAndDenseSmokeAreBothRight) {
    const glm::dvec3 spacing(0.5);
    const TestVolume slab = makeSlab(spacing, 14);
    const Volume volume = throughRaw(slab, spacing);
    for (const double alongExtinction : {0.01, 3.0, 8.0}) {
        expectSlab(slab, volume, 30, alongExtinction, 1);
    }
}

}  // namespace
}  // namespace deltasplat::test
