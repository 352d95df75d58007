// SPDX-License-Identifier: Apache-2.0
// Normals that channels tell: those of balls.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <vector>

#include "deltasplat/render_aovs.h"
#include "support/error_of.h"
#include "support/same_picture.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::Colors;
using test::errorOf;

std::vector<glm::dvec3> normalsOf(const Volume& volume, const RenderOptions& options) {
    const Camera camera = test::cameraOf(volume, options.camera);
    const std::vector<ImageChannel> channels =
        renderAovs(volume, options, camera, std::vector{Aov::kNormal});
    EXPECT_EQ(channels.size(), 3u);
    std::vector<glm::dvec3> normals(channels[0].values.size());
    for (int axis = 0; axis < 3; ++axis) {
        const ImageChannel& channel = channels[std::size_t(axis)];
        EXPECT_EQ(channel.name, std::string("N.") + "XYZ"[axis]);
        for (std::size_t i = 0; i < normals.size(); ++i) normals[i][axis] = channel.values[i];
    }
    return normals;
}

constexpr double kRadius = 18;
constexpr glm::dvec3 kSize(0.5, 0.5, 0.75);

// A ball around the origin whose values grow evenly to its middle.
Volume ball() {
    const IndexBox box{{-24, -24, -16}, {24, 24, 16}};
    return test::makeVolume(
        box,
        [](int x, int y, int z) {
            const double r = glm::length(kSize * glm::dvec3(x, y, z)) / kSize.x;
            return int(30000 + 1000 * (kRadius - r));
        },
        kSize);
}

std::vector<CameraOptions> cameras() {
    std::vector<CameraOptions> cameras(4);
    for (CameraOptions& camera : cameras) camera.sizePixels = {56, 56};
    cameras[1].direction = glm::dvec3(0.4, -0.7, 0.5);
    cameras[2].direction = glm::dvec3(-1, 0.3, -0.4);
    cameras[2].projection = Projection::kPerspective;
    cameras[2].fovDegrees = 50;
    cameras[3].projection = Projection::kLatlong;
    cameras[3].sizePixels = {160, 80};
    cameras[3].eyeWorld = glm::dvec3(11, 4, 3);
    return cameras;
}

std::size_t indexOf(const Camera& camera, int x, int y) {
    return std::size_t(y) * std::size_t(camera.sizePixels.x) + std::size_t(x);
}

// Where a pixel's line of sight meets the ball's surface, unless that is at a grazing angle.
bool meets(const Camera& camera, int x, int y, glm::dvec3& place, glm::dvec3& way) {
    const glm::dvec2 pixel(x + 0.5, y + 0.5);
    const bool isParallel = camera.projection == Projection::kOrtho;
    way = isParallel ? camera.direction : glm::normalize(camera.rayThrough(pixel));
    const glm::dvec3 from =
        isParallel ? camera.worldFromPixel(pixel) - 100.0 * way : camera.eyeWorld();
    const double r = kRadius * kSize.x;
    const double along = -glm::dot(from, way);
    const double square = glm::dot(from, from) - along * along;
    if (along < 0 || square > 0.75 * r * r) return false;
    place = from + (along - std::sqrt(r * r - square)) * way;
    return true;
}

TEST(AovNormals, ofABallAreItsRadii) {
    const Volume volume = ball();
    for (const bool isSurface : {true, false}) {
        for (const int between : {0, 1}) {
            for (const CameraOptions& cameraOptions : cameras()) {
                RenderOptions options;
                options.camera = cameraOptions;
                options.splat.between = between;
                if (isSurface) options.optics.surface = Surface{30000, {0.2, 0.5, 0.9}};
                options.optics.transferFunction.colors = {{0, {0, 0.5, 1}}, {60000, {1, 1, 0}}};
                options.optics.transferFunction.opacities = {{29500, 0, 0.5, 0},
                                                             {30500, 1, 0.5, 0}};
                const Camera camera = test::cameraOf(volume, cameraOptions);
                const std::vector<glm::dvec3> normals = normalsOf(volume, options);
                int met = 0;
                double angle = 0;
                double shortest = 1;
                double longest = 0;
                for (int y = 0; y < camera.sizePixels.y; ++y) {
                    for (int x = 0; x < camera.sizePixels.x; ++x) {
                        glm::dvec3 place, way;
                        if (!meets(camera, x, y, place, way)) continue;
                        ++met;
                        const glm::dvec3 n = normals[indexOf(camera, x, y)];
                        const double length = glm::length(n);
                        shortest = std::min(shortest, length);
                        longest = std::max(longest, length);
                        const double cosine = glm::dot(n, glm::normalize(place)) / length;
                        angle = std::max(angle, std::acos(std::min(1.0, cosine)) * 57.2958);
                    }
                }
                EXPECT_GT(met, 300);
                EXPECT_LT(angle, between == 0 && isSurface ? 6 : 3);
                // Of a function's ramp not all of a voxel is shaded.
                EXPECT_GT(shortest, isSurface ? 0.98 : 0.9);
                EXPECT_LT(longest, isSurface ? 1.02 : 0.98);
            }
        }
    }
}

TEST(AovNormals, areTheSameForEveryMethodAndThread) {
    const auto volume = test::someVolume();
    for (const int camera : {1, 6}) {
        RenderOptions options;
        options.optics = test::someOptics(Colors::kSeveral);
        options.camera = test::someCameras()[std::size_t(camera)];
        test::expectTheSameHoweverMade([&](Method method) {
            options.splat.method = method;
            return normalsOf(*volume, options);
        });
    }
}

// Whatever else the voxels look like: it is seen where the picture is, and nowhere else.
TEST(AovNormals, areOfWhateverIsSeen) {
    const auto volume = test::someVolume();
    for (const Colors colors : {Colors::kOne, Colors::kOwn, Colors::kLit, Colors::kFog}) {
        RenderOptions options;
        options.optics = test::someOptics(colors);
        options.camera = test::someCameras()[5];
        const RenderResult beauty = render(*volume, options);
        const std::vector<glm::dvec3> normals = normalsOf(*volume, options);
        int seen = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const float alpha = beauty.image.rgba[4 * i + 3];
            if (alpha == 0) {
                EXPECT_EQ(normals[i], glm::dvec3(0));
            }
            // Half of the way to the camera, or more.
            if (alpha > 0.5) {
                ++seen;
                EXPECT_GT(glm::length(normals[i]), 0.05);
                EXPECT_LT(glm::length(normals[i]), 1.05);
            }
        }
        EXPECT_GT(seen, 500);
    }
}

// Where values hardly change there are all normals that face the camera.
TEST(AovNormals, ofEvenFogAreHalfTheWayToTheCamera) {
    const Volume volume = test::makeVolume(
        {{0, 0, 0}, {30, 30, 30}}, [](int x, int, int) { return x == 0 ? 0 : 100 + x % 2; });
    RenderOptions options;
    options.optics.transferFunction.opacities = {{0, 0.2, 0.5, 0}};
    options.camera.direction = glm::dvec3(0, -0.3, -1);
    options.camera.sizePixels = {32, 32};
    const std::vector<glm::dvec3> normals = normalsOf(volume, options);
    const glm::dvec3 n = normals[16 * 32 + 16];
    const glm::dvec3 half = -0.5 * glm::normalize(*options.camera.direction);
    EXPECT_LT(glm::distance(n, half), 2e-3);
}

TEST(AovNormals, areRefusedOfSeveralGrids) {
    const auto volume = test::someVolume();
    RenderOptions options;
    options.optics = test::someOptics(Colors::kOne);
    MediumPart part;
    part.volume = volume;
    part.kind = MediumPart::Kind::kAbsorption;
    part.transferFunction = options.optics.transferFunction;
    options.optics.parts = {part};
    EXPECT_EQ(
        errorOf([&] { normalsOf(*volume, options); }),
        "usage: `aovs` normal: got a medium of several grids that swallow light; expected one "
        "that does");
}

}  // namespace
}  // namespace deltasplat
