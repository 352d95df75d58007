// SPDX-License-Identifier: Apache-2.0
// Things appear where they are: corners at their pixels, shifted volumes unchanged, one voxel with
// all its light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "deltasplat/render.h"
#include "property/test_scene.h"

namespace deltasplat::test {
namespace {

// The named views by hand: where the picture's right and top are.
struct HandView {
    const char* name;
    glm::dvec3 right, up;
};

const HandView kHandViews[] = {
    {"front", {1, 0, 0}, {0, 1, 0}},
    {"back", {-1, 0, 0}, {0, 1, 0}},
    {"left", {0, 0, 1}, {0, 1, 0}},
    {"right", {0, 0, -1}, {0, 1, 0}},
    {"top", {1, 0, 0}, {0, 0, -1}},
    {"bottom", {1, 0, 0}, {0, 0, 1}},
    {"iso",
     {std::sqrt(0.5), 0, -std::sqrt(0.5)},
     {-std::sqrt(1 / 6.0), std::sqrt(2 / 3.0), -std::sqrt(1 / 6.0)}},
};

const float kCornerValues[8] = {20, 50, 80, 110, 140, 170, 200, 230};

// Each corner's value has a hue of its own.
glm::dvec3 cornerColor(int corner) {
    return {corner & 1 ? 1 : 0.2, corner & 2 ? 1 : 0.2, corner & 4 ? 0.9 : 0.5};
}

glm::ivec3 cornerIndex(const TestVolume& volume, int corner) {
    const glm::ivec3 last = volume.first + volume.dims - 1;
    return {corner & 1 ? last.x : volume.first.x, corner & 2 ? last.y : volume.first.y,
            corner & 4 ? last.z : volume.first.z};
}

TestVolume makeCorners(const glm::ivec3& first, const glm::dmat4& worldFromIndex) {
    TestVolume volume(first, {7, 9, 11});
    volume.worldFromIndex = worldFromIndex;
    for (int corner = 0; corner < 8; ++corner) {
        volume.at(cornerIndex(volume, corner)) = kCornerValues[corner];
    }
    return volume;
}

// The corner whose colour is most like a pixel's, up to brightness; -1 if the pixel is faint.
int nearestCorner(const float* pixel) {
    if (pixel[3] < 0.5f) return -1;
    const glm::dvec3 rgb = glm::normalize(glm::dvec3(pixel[0], pixel[1], pixel[2]) + 1e-9);
    int nearest = 0;
    const auto likeness = [&](int c) { return glm::dot(rgb, glm::normalize(cornerColor(c))); };
    for (int c = 1; c < 8; ++c) {
        if (likeness(c) > likeness(nearest)) nearest = c;
    }
    return nearest;
}

// Looks at the eight corners; those that lie exactly behind another one are hidden by it.
void expectCornersInPlace(const TestVolume& corners, const Volume& volume, const HandView& hand) {
    SCOPED_TRACE(hand.name);
    RenderOptions options;
    options.camera.view = hand.name;
    options.camera.sizePixels = {165, 135};
    const double pixelWorld = 0.2 * volume.voxelSize().x;
    options.camera.frameWidthWorld = pixelWorld * options.camera.sizePixels.x;
    options.splat.sigma = 0.2;
    options.splat.resolution = 4;
    TransferFunction& function = options.optics.transferFunction;
    function.linearColors = true;
    for (int corner = 0; corner < 8; ++corner) {
        function.colors.push_back({kCornerValues[corner], cornerColor(corner)});
    }
    function.opacities = {{0, 0, 0.5, 0}, {10, 1, 0.5, 0}};
    const RenderResult result = render(volume, options);

    const glm::dvec3 middle =
        corners.world(glm::dvec3(corners.first) + 0.5 * glm::dvec3(corners.dims - 1));
    const glm::dvec3 towardsCamera = glm::cross(hand.right, hand.up);
    int seen = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 offset = corners.world(cornerIndex(corners, corner)) - middle;
        const glm::dvec2 pixel(82.5 + glm::dot(offset, hand.right) / pixelWorld,
                               67.5 - glm::dot(offset, hand.up) / pixelWorld);
        int front = corner;
        for (int other = 0; other < 8; ++other) {
            const glm::dvec3 between = corners.world(cornerIndex(corners, other)) - middle - offset;
            const double nearer = glm::dot(between, towardsCamera);
            if (nearer > 0 && glm::length(between - nearer * towardsCamera) < 1e-6) front = other;
        }
        if (front == corner) ++seen;
        const glm::ivec2 at(glm::floor(pixel));
        ASSERT_TRUE(at.x >= 0 && at.y >= 0 && at.x < 165 && at.y < 135);
        EXPECT_EQ(nearestCorner(result.image.pixel(at.x, at.y)), front) << "corner " << corner;
    }
    EXPECT_EQ(seen, std::string(hand.name) == "iso" ? 8 : 4);
}

TEST(Placement, nothingIsMirroredInAnyNamedView) {
    const TestVolume plain = makeCorners({0, 0, 0}, spaced({1, 1, 1}));
    const Volume raw = throughRaw(plain, {1, 1, 1});
    for (const HandView& hand : kHandViews) expectCornersInPlace(plain, raw, hand);
}

TEST(Placement, nothingIsMirroredWithNegativeIndicesAndUnevenVoxels) {
    const TestVolume uneven = makeCorners({-30, 4, -6}, spaced({1, 1.25, 0.75}, {5, -9, 2}));
    const Volume vdb = throughVdb(uneven);
    for (const HandView& hand : kHandViews) expectCornersInPlace(uneven, vdb, hand);
}

TestVolume makeNoise(const glm::ivec3& dims) {
    std::mt19937 random(23);
    TestVolume volume({0, 0, 0}, dims);
    for (float& value : volume.values) value = random() % 3 == 0 ? float(random() % 256) : 0;
    return volume;
}

TEST(Placement, aVolumeShiftedInTheWorldLooksTheSame) {
    TestVolume volume = makeNoise({12, 9, 14});
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(0.4);
    options.camera.view = "iso";
    options.camera.azimuthDegrees = 17;
    options.camera.sizePixels = {96, 80};
    volume.worldFromIndex = spaced({1, 1, 2});
    const Image here = render(throughVdb(volume), options).image;
    volume.worldFromIndex = spaced({1, 1, 2}, {-4096, 512, 1.0 / 3});
    const Image there = render(throughVdb(volume), options).image;

    // Rounding of the camera's place may move a look-up in the warp's filter table by one step.
    double brightest = 0;
    for (std::size_t i = 0; i < here.rgba.size(); ++i) {
        ASSERT_NEAR(here.rgba[i], there.rgba[i], 1e-3) << i;
        brightest = std::max(brightest, double(here.rgba[i]));
    }
    EXPECT_GT(brightest, 0.5);
}

TEST(Placement, aPictureDoesNotDependOnHowALargeFrameIsCut) {
    // The right half of a picture is the picture of half the frame, looked at from its middle.
    const TestVolume volume = makeNoise({12, 9, 14});
    const Volume read = throughVdb(volume);
    TestView view;
    view.direction = {0.3, -0.4, -1};
    view.target = {6, 4, 7};
    view.pixelWorld = 0.25;
    view.size = {96, 64};
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(0.4);
    options.camera = view.options();
    options.splat.resolution = 2;
    const Image whole = render(read, options).image;
    const reference::View axes = view.view();
    view.target += 24 * view.pixelWorld * glm::dvec3(axes.right[0], axes.right[1], axes.right[2]);
    view.size.x = 48;
    options.camera = view.options();
    const Image half = render(read, options).image;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 48; ++x) {
            for (int c = 0; c < 4; ++c) {
                ASSERT_NEAR(half.pixel(x, y)[c], whole.pixel(x + 48, y)[c], 1e-3) << x << ' ' << y;
            }
        }
    }
}

TEST(Placement, oneVoxelKeepsAllItsLight) {
    // Whatever the footprint, the weights of a voxel add up to one voxel's face: the picture's sum
    // is the voxel's alpha times the face's area on the screen, in pixels.
    TestVolume volume({3, -8, 5}, {1, 1, 1});
    volume.values = {255};
    volume.worldFromIndex = spaced({1, 1.5, 2}, {7, 7, 7});
    const Volume read = throughVdb(volume);
    const double opacity = 0.4;
    const struct {
        glm::dvec3 directionIndex;
        int sliceAxis;
    } cases[] = {{{0, 0, -1}, 2}, {{1, 0.2, -0.7}, 0}, {{0.5, -1, 0.9}, 1}, {{-0.9, 0.6, 1}, 2}};
    for (const auto& c : cases) {
        SCOPED_TRACE(c.sliceAxis);
        const glm::dmat3 linear(volume.worldFromIndex);
        TestView view;
        view.direction = linear * c.directionIndex;
        view.up = {0.1, 1, 0.2};
        view.target = volume.world(volume.first);
        view.pixelWorld = 0.05;
        view.size = {400, 400};
        RenderOptions options;
        options.camera = view.options();
        options.optics.transferFunction = testTransferFunction(opacity);
        options.optics.unitDistance = 1.25;
        options.splat.sigma = 0.8;
        options.splat.resolution = 8;
        const RenderResult result = render(read, options);
        ASSERT_EQ(result.stats.sliceAxis, c.sliceAxis);

        const glm::dvec3 along = glm::normalize(view.direction);
        const glm::dvec3 face =
            glm::cross(linear[(c.sliceAxis + 1) % 3], linear[(c.sliceAxis + 2) % 3]);
        const double facePixels =
            std::abs(glm::dot(face, along)) / (view.pixelWorld * view.pixelWorld);
        const double stepWorld =
            glm::length(view.direction) / std::abs(c.directionIndex[c.sliceAxis]);
        const double alpha = 1 - std::exp(std::log(1 - opacity) / 1.25 * stepWorld);
        double sums[4] = {0, 0, 0, 0};
        for (std::size_t i = 0; i < result.image.rgba.size(); ++i) {
            sums[i % 4] += result.image.rgba[i];
        }
        EXPECT_NEAR(sums[3] / (alpha * facePixels), 1, 2e-3);
        EXPECT_NEAR(sums[0] / (alpha * facePixels), 1, 2e-3);
        EXPECT_NEAR(sums[1], 0, 1e-6);
        EXPECT_NEAR(sums[2] / (alpha * facePixels), 0.25, 1e-3);
    }
}

TEST(Placement, anEmptyVolumeIsATransparentPicture) {
    const RenderResult result = render(throughVdb(TestVolume({0, 0, 0}, {4, 4, 4})), [] {
        RenderOptions options;
        options.optics.transferFunction = testTransferFunction(0.5);
        options.camera.sizePixels = {7, 5};
        return options;
    }());
    EXPECT_EQ(result.image.size, glm::ivec2(7, 5));
    EXPECT_EQ(result.image.rgba, std::vector<float>(4 * 7 * 5, 0.0f));
}

}  // namespace
}  // namespace deltasplat::test
