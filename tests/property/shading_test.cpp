// SPDX-License-Identifier: Apache-2.0
// Lit surfaces, against formulas written out, a renderer that shares no code, and what must stay
// the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/render.h"
#include "property/test_scene.h"
#include "support/error_of.h"
#include "support/make_volume.h"
#include "support/mirrored.h"
#include "support/sight_line.h"

namespace deltasplat::test {
namespace {

constexpr double kOpacity = 0.3;

// Oblong, turned and mirrored.
glm::dmat4 someTransform() {
    const glm::dvec3 a = glm::normalize(glm::dvec3(1, 0.2, -0.1));
    const glm::dvec3 b = glm::normalize(glm::cross(glm::dvec3(0.1, 0, 1), a));
    glm::dmat4 world(glm::dmat3(1.2 * a, 0.9 * b, -1.1 * glm::cross(a, b)));
    world[3] = {4, -2, 7, 1};
    return world;
}

// Waves, steep and flat, with holes.
TestVolume wavyVolume() {
    TestVolume volume({-3, 0, 5}, {13, 17, 11});
    volume.worldFromIndex = someTransform();
    std::mt19937 random(5);
    for (int z = 0; z < volume.dims.z; ++z) {
        for (int y = 0; y < volume.dims.y; ++y) {
            for (int x = 0; x < volume.dims.x; ++x) {
                const double wave =
                    120 + 70 * std::sin(0.9 * x + 0.3 * z) * std::cos(0.4 * y) + 0.2 * z;
                volume.at(volume.first + glm::ivec3(x, y, z)) =
                    random() % 6 == 0 ? 0.0f : float(std::round(wave));
            }
        }
    }
    // The box of what is active is all of it.
    volume.at(volume.first) = volume.at(volume.first + volume.dims - 1) = 200;
    return volume;
}

double valueAt(TestVolume& volume, const glm::ivec3& index) {
    const glm::ivec3 p = index - volume.first;
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < 0 || p[axis] >= volume.dims[axis]) return 0;
    return volume.at(index);
}

Shading someShading() {
    Shading shading;
    shading.ambient = 0.1;
    shading.diffuse = 0.6;
    shading.specular = 0.3;
    shading.shininess = 7;
    shading.lights = {{LightFrame::kWorld, {1, -2, 0.5}, {1, 0.8, 0.3}, 0.7},
                      {LightFrame::kView, {-1, 0.2, -2}, {0.2, 0.3, 1}, 1.1},
                      {LightFrame::kHead, {}, {0.5, 0.5, 0.5}, 0.9}};
    return shading;
}

struct Eye {
    glm::dvec3 toCamera;             // from what is lit
    glm::dvec3 right, up, backward;  // of the camera
};

// By the formulas of the documentation, written out.
glm::dvec3 lit(const Shading& shading, const glm::dvec3& color, const glm::dvec3& gradient,
               double noise, const Eye& eye) {
    const double steepness = glm::length(gradient);
    const double share = steepness * steepness / (steepness * steepness + noise * noise);
    glm::dvec3 n = steepness > 0 ? gradient / steepness : glm::dvec3(0);
    if (glm::dot(n, eye.toCamera) < 0) n = -n;
    glm::dvec3 result = shading.ambient * color;
    for (const Light& light : shading.lights) {
        const glm::dvec3 d = light.direction;
        glm::dvec3 l = -glm::normalize(d);
        if (light.frame == LightFrame::kHead) l = eye.toCamera;
        if (light.frame == LightFrame::kView)
            l = -glm::normalize(d.x * eye.right + d.y * eye.up + d.z * eye.backward);
        const glm::dvec3 h = glm::normalize(l + eye.toCamera);
        const double facing = std::max(0.0, glm::dot(n, l));
        const double average = (1 + glm::dot(l, eye.toCamera)) / 4;
        const glm::dvec3 intensity = light.strength * light.color;
        result += shading.diffuse * color * intensity * (share * facing + (1 - share) * average);
        if (facing > 0)
            result += shading.specular * share * intensity *
                      std::pow(std::max(0.0, glm::dot(n, h)), shading.shininess);
    }
    return result;
}

reference::Volume litVolume(TestVolume volume, const Shading& shading, double noise,
                            const Eye& eye) {
    reference::Volume voxels = referenceVolume(volume, kOpacity, 0.9);
    const glm::dmat3 worldFromGradient =
        glm::transpose(glm::inverse(glm::dmat3(volume.worldFromIndex)));
    std::size_t i = 0;
    for (int z = 0; z < volume.dims.z; ++z) {
        for (int y = 0; y < volume.dims.y; ++y) {
            for (int x = 0; x < volume.dims.x; ++x) {
                const glm::ivec3 index = volume.first + glm::ivec3(x, y, z);
                glm::dvec3 slopes;
                for (int axis = 0; axis < 3; ++axis) {
                    glm::ivec3 step(0);
                    step[axis] = 1;
                    slopes[axis] =
                        0.5 * (valueAt(volume, index + step) - valueAt(volume, index - step));
                }
                auto& color = voxels.voxels[i++].color;
                const glm::dvec3 result = lit(shading, {color[0], color[1], color[2]},
                                              0.9 * (worldFromGradient * slopes), noise, eye);
                color = {result.x, result.y, result.z};
            }
        }
    }
    return voxels;
}

double noiseOf(const Volume& volume) {
    const glm::dvec2 bulk = bulkRange(volume);
    return (bulk.y - bulk.x) / 100;
}

TEST(Shading, agreesWithTheReference) {
    const TestVolume volume = wavyVolume();
    const Volume read = throughVdb(volume);
    for (const glm::dvec3& direction :
         {glm::dvec3(0.1, 0.05, -1), glm::dvec3(-1, 0.6, 0.5), glm::dvec3(0.3, 1, -0.8)}) {
        TestView view;
        view.direction = direction;
        view.up = {0.2, 1, 0.3};
        view.target = volume.world(glm::dvec3(volume.first) + 0.5 * glm::dvec3(volume.dims - 1));
        view.pixelWorld = 0.2;
        view.size = {96, 80};
        const reference::View plain = view.view();
        const glm::dvec3 toCamera(-plain.direction[0], -plain.direction[1], -plain.direction[2]);
        const Eye eye{toCamera,
                      {plain.right[0], plain.right[1], plain.right[2]},
                      {plain.up[0], plain.up[1], plain.up[2]},
                      toCamera};
        RenderOptions options;
        options.camera = view.options();
        options.optics.transferFunction = testTransferFunction(kOpacity);
        options.optics.shading = someShading();
        options.splat.sigma = 0.4;
        options.splat.resolution = 2;
        const RenderResult result = render(read, options);
        const auto expected = reference::renderSampled(
            litVolume(volume, someShading(), noiseOf(read), eye), plain, 0.4, 2);
        EXPECT_GE(psnr(result.image, expected), 60);
    }
}

// A ball whose values fall across its surface, with what is seen of it.
constexpr double kRadius = 30;

Volume ball(double noise = 0) {
    std::mt19937 random(3);
    const int half = int(kRadius) + 6;
    return test::makeVolume({{-half, -half, -half}, {half, half, half}}, [&](int x, int y, int z) {
        const double depth = kRadius - glm::length(glm::dvec3(x, y, z));
        const double value = 2000 + 500 * std::clamp(depth, -4.0, 4.0);
        return int(value + noise * (int(random() % 3) - 1));
    });
}

RenderOptions opaqueAbove(double value) {
    RenderOptions options;
    options.optics.transferFunction.colors = {{0, {0.8, 0.8, 0.8}}};
    options.optics.transferFunction.linearColors = true;
    options.optics.transferFunction.opacities = {{value, 0, 0.5, 0}, {value, 1, 0.5, 0}};
    options.optics.shading.emplace();
    options.camera.sizePixels = {160, 160};
    options.camera.frameWidthWorld = 80;
    return options;
}

// Lambert's law and Blinn's highlight, in parallel and from an eye.
TEST(Shading, ofABallIsTheClosedForm) {
    const Volume volume = ball();
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        RenderOptions options = opaqueAbove(2000);
        options.camera.projection = projection;
        options.camera.view = "iso";
        if (projection == Projection::kPerspective) {
            options.camera.frameWidthWorld.reset();
            options.camera.fovDegrees = 40;
            options.camera.distanceWorld = 110;
        }
        Shading& shading = *options.optics.shading;
        shading = someShading();
        options.splat.between = 3;
        const RenderResult result = render(volume, options);
        const Camera& camera = result.camera;
        double squares = 0;
        int pixels = 0;
        for (int y = 0; y < 160; ++y) {
            for (int x = 0; x < 160; ++x) {
                const glm::dvec2 pixel(x + 0.5, y + 0.5);
                const auto [start, ray] = sightLineOf(camera, pixel, 200);
                const double b = glm::dot(start, ray);
                const double beyond = b * b - glm::dot(start, start) + kRadius * kRadius;
                // The last few pixels before the outline are seen through its own blur.
                if (beyond < 8 * kRadius) continue;
                const glm::dvec3 normal = (start - (b + std::sqrt(beyond)) * ray) / kRadius;
                const glm::dvec3 expected = lit(shading, glm::dvec3(0.8), normal, 0,
                                                {-ray, camera.right, camera.up, -camera.direction});
                const glm::dvec3 seen(result.image.rgba[4 * (160 * y + x)],
                                      result.image.rgba[4 * (160 * y + x) + 1],
                                      result.image.rgba[4 * (160 * y + x) + 2]);
                squares += glm::dot(seen - expected, seen - expected) / 3;
                ++pixels;
            }
        }
        EXPECT_GT(pixels, 5000);
        EXPECT_GT(-10 * std::log10(squares / pixels), 40) << projectionName(projection);
    }
}

// Half the light, half the picture, however dark.
TEST(Shading, isAsDarkAsItsLight) {
    const Volume volume = ball();
    RenderOptions options = opaqueAbove(2000);
    const auto middleWith = [&](double share) {
        Shading shading = someShading();
        shading.specular = 0;
        shading.ambient *= share;
        shading.diffuse *= share;
        options.optics.shading = shading;
        const Image image = render(volume, options).image;
        const float* rgba = image.pixel(80, 80);
        return glm::dvec3(rgba[0], rgba[1], rgba[2]);
    };
    const glm::dvec3 all = middleWith(1);
    EXPECT_GT(all.x, 0.1);
    for (const double share : {0.5, 1e-3, 1e-30}) {
        const glm::dvec3 seen = middleWith(share);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], share * all[i], 0.01 * share * all[i]);
    }
}

// Where values hardly change, nothing sparkles: far inside, all is lit as by all directions.
TEST(Shading, addsNoNoiseToWhatIsHomogeneous) {
    const auto spread = [](const Image& image) {
        double low = 1e9;
        double high = 0;
        for (int y = 60; y < 100; ++y) {
            for (int x = 60; x < 100; ++x) {
                const double red = image.rgba[4 * (std::size_t(y) * 160 + std::size_t(x))];
                low = std::min(low, red);
                high = std::max(high, red);
            }
        }
        return std::pair(low, high);
    };
    RenderOptions options = opaqueAbove(1000);
    // Cut open: what is seen lies inside.
    const auto slab = [&](double noise) {
        std::mt19937 random(3);
        return test::makeVolume({{0, 0, 0}, {79, 79, 40}}, [&](int, int, int z) {
            return z < 20 ? 2000 + int(noise * (int(random() % 3) - 1)) : 4000;
        });
    };
    options.camera.view = "back";
    const auto [still, stillHigh] = spread(render(slab(0), options).image);
    EXPECT_EQ(still, stillHigh);
    const Shading& shading = *options.optics.shading;
    EXPECT_NEAR(still, 0.8 * (shading.ambient + shading.diffuse / 2), 1e-3);
    const auto [low, high] = spread(render(slab(1), options).image);
    EXPECT_LT(high - low, 0.02);
}

// Bit for bit: a world turned inside out, seen by a camera and lit by lights that are so as well.
TEST(Shading, mirrorsWithTheScene) {
    Volume volume = test::randomVolume({{0, 0, 0}, {30, 25, 28}}, 4, 0.3, {1, 1.2, 0.8});
    for (const int between : {0, 1}) {
        RenderOptions options;
        options.optics.transferFunction = testTransferFunction(kOpacity);
        options.optics.shading = someShading();
        options.camera.sizePixels = {64, 64};
        options.camera.direction = glm::dvec3(-0.3, -0.4, -1);
        options.camera.targetWorld = glm::dvec3(15, 14, 11);
        options.splat.between = between;
        const Image image = render(volume, options).image;
        test::changed(volume)->worldFromIndex[0] = -volume.worldFromIndex()[0];
        options.camera.direction->x = -options.camera.direction->x;
        options.camera.targetWorld->x = -options.camera.targetWorld->x;
        for (Light& light : options.optics.shading->lights) light.direction.x = -light.direction.x;
        const Image other = render(volume, options).image;
        test::changed(volume)->worldFromIndex[0] = -volume.worldFromIndex()[0];
        EXPECT_EQ(mirrored(other).rgba, image.rgba);
    }
}

// All turned together is the same picture, but for the rounding of directions.
TEST(Shading, turnsWithTheScene) {
    Volume volume = test::randomVolume({{0, 0, 0}, {30, 25, 28}}, 4, 0.3, {1, 1.2, 0.8});
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(kOpacity);
    options.optics.shading = someShading();
    options.camera.sizePixels = {64, 64};
    // No gradient of small numbers lies level with it: either side of one that does may be seen.
    options.camera.direction = glm::dvec3(-0.31337, -0.44721, -1);
    options.camera.up = glm::dvec3(0, 1, 0);
    options.camera.targetWorld = glm::dvec3(15, 14, 11);
    options.camera.frameWidthWorld = 50;
    const Image image = render(volume, options).image;
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 1.234, glm::dvec3(0.3, 0.5, -0.7));
    const auto turned = [&](const glm::dvec3& v) { return glm::dvec3(turn * glm::dvec4(v, 0)); };
    test::changed(volume)->worldFromIndex = turn * volume.worldFromIndex();
    options.camera.direction = turned(*options.camera.direction);
    options.camera.up = turned(*options.camera.up);
    options.camera.targetWorld = turned(*options.camera.targetWorld);
    for (Light& light : options.optics.shading->lights)
        if (light.frame == LightFrame::kWorld) light.direction = turned(light.direction);
    const Image other = render(volume, options).image;
    double most = 0;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        most = std::max(most, double(std::abs(image.rgba[i] - other.rgba[i])));
    EXPECT_LT(most, 1e-3);
}

// A tolerance changes nothing: all is exact, and said to be.
TEST(Shading, isExactUnderATolerance) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {30, 25, 28}}, 4, 0.3);
    RenderOptions options;
    options.optics.transferFunction = testTransferFunction(kOpacity);
    options.optics.shading = someShading();
    options.camera.sizePixels = {64, 64};
    const Image exact = render(volume, options).image;
    options.splat.tolerance = {0.3, 0};
    const RenderResult result = render(volume, options);
    EXPECT_EQ(result.image.rgba, exact.rgba);
    EXPECT_EQ(result.stats.errorBoundColor, 0);
    EXPECT_EQ(result.stats.errorBoundAlpha, 0);
}

// Steep beyond all measure, and of one value.
TEST(Shading, isFiniteWhateverTheValues) {
    for (const double large : {0.0, 1.0, 1e30, 1e300}) {
        TestVolume volume({0, 0, 0}, {9, 9, 9});
        std::fill(volume.values.begin(), volume.values.end(), 1.0f);
        Volume read = throughVdb(volume);
        std::mt19937 random(3);
        if (large > 0) {
            read = test::makeVolume({{0, 0, 0}, {8, 8, 8}},
                                    [&](int, int, int) { return int(random() % 2); });
            test::changed(read)->codeBook = CodeBook::ofTable({0, large});
            test::changed(read)->valueMin = 0;
            test::changed(read)->valueMax = large;
        }
        RenderOptions options = opaqueAbove(0.5 * std::max(large, 1.0));
        options.camera.frameWidthWorld.reset();
        options.camera.view = "iso";
        const Image image = render(read, options).image;
        double most = 0;
        for (const float value : image.rgba) {
            ASSERT_TRUE(std::isfinite(value));
            most = std::max(most, double(value));
        }
        EXPECT_GT(most, 0.1) << large;
    }
}

TEST(Shading, refusesLightsThatAreNone) {
    const Volume volume = test::randomVolume({{0, 0, 0}, {8, 8, 8}}, 4, 0.3);
    RenderOptions options;
    const auto messageOf = [&](const Shading& shading) {
        options.optics.transferFunction = testTransferFunction(kOpacity);
        options.optics.shading = shading;
        return errorOf([&] { render(volume, options); });
    };
    const auto withLight = [](const Light& light) {
        Shading shading;
        shading.lights = {light};
        return shading;
    };
    EXPECT_EQ(messageOf(withLight({LightFrame::kWorld, {0, 0, 0}})),
              "usage: `shading.lights` direction: got 0,0,0; expected not all 0");
    EXPECT_EQ(messageOf(withLight({LightFrame::kView, {0, NAN, 0}})),
              "usage: `shading.lights` direction: got 0,nan,0; expected finite numbers");
    EXPECT_EQ(messageOf(withLight({LightFrame::kHead, {}, {1, -1, 1}})),
              "usage: `shading.lights` colour: got -1; expected a number within 0..1e6");
    EXPECT_EQ(messageOf(withLight({LightFrame::kHead, {}, {1, 1, 1}, NAN})),
              "usage: `shading.lights` strength: got nan; expected a number within 0..1e6");
    Shading shading;
    shading.diffuse = -0.5;
    EXPECT_EQ(messageOf(shading),
              "usage: `shading.diffuse`: got -0.5; expected a number within 0..1e6");
    options.optics.colorBy = ColorBy::kX;
    EXPECT_EQ(messageOf({}), "usage: `shading`: got `colorBy` x besides; expected `colorBy` value");
}

}  // namespace
}  // namespace deltasplat::test
