// SPDX-License-Identifier: Apache-2.0
// Point lights in fog, against what is reckoned along single ways, and what must stay the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "support/error_of.h"
#include "support/lit_fog.h"
#include "support/make_volume.h"
#include "support/mirrored.h"
#include "support/same_picture.h"
#include "support/sight_line.h"

namespace deltasplat {
namespace {

using test::aroundMiddle;
using test::Ball;
using test::errorOf;
using test::fogOf;
using test::fogOptics;
using test::kPi;
using test::phaseOf;

Light pointAt(const glm::dvec3& world, double strength, double radius = 0,
              const glm::dvec3& color = glm::dvec3(1)) {
    Light light = test::pointAt(world);
    light.strength = strength;
    light.radiusWorld = radius;
    light.color = color;
    return light;
}

double redOf(const Image& image, int x, int y) {
    return image.pixel(x, y)[0];
}

double meanOf(const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return 4 * sum / double(image.rgba.size());
}

// Red, of what one light shows, by the formulas of the documentation.
// @param voxel  world size
double shownOf(const Light& light, const Ball& ball, const Scattering& fog, const glm::dvec3& p,
               const glm::dvec3& ray, double voxel) {
    double share = 1;
    double oneSide = 1;
    double depth = 0;
    glm::dvec3 way;
    if (light.positionWorld) {
        const double r = glm::distance(p, *light.positionWorld);
        const double least = std::max(light.radiusWorld, 0.358 * voxel);
        share = 1 / std::pow(std::max(r, least), 2);
        oneSide = std::min(1.0, r / least);
        way = (p - *light.positionWorld) / r;
        depth = ball.depthBetween(*light.positionWorld, p);
    } else {
        way = glm::normalize(light.direction);
        depth = ball.depthAt(p, way);
    }
    double sum = 0;
    for (int i = 0; i <= fog.octaves; ++i) {
        const double part = std::pow(0.5, i);
        const double phase =
            oneSide * phaseOf(fog, i, glm::dot(way, -ray)) + (1 - oneSide) / (4 * kPi);
        sum += std::pow(fog.albedo.x, i) * kPi * part * phase * std::exp(-depth * part);
    }
    return light.strength * light.color.x * share * sum;
}

double radianceOf(const Ball& ball, const Scattering& fog, const test::SightLine& line,
                  double voxel) {
    constexpr double kStep = 0.1;
    double sum = 0;
    double seen = 0;  // extinction in front
    for (double t = kStep / 2; t < 200; t += kStep) {
        const glm::dvec3 p = line.start + t * line.ray;
        const double extinction = ball.extinctionAt(p) * kStep;
        if (extinction < 1e-9) continue;
        double light = fog.ambient.x;
        for (const Light& one : fog.lights) light += shownOf(one, ball, fog, p, line.ray, voxel);
        sum += std::exp(-seen - extinction / 2) * -std::expm1(-extinction) * fog.albedo.x * light;
        seen += extinction;
    }
    return sum;
}

Scattering someFog() {
    Scattering fog;
    fog.albedo = glm::dvec3(0.9, 0.8, 0.7);
    fog.anisotropy = 0.5;
    fog.backAnisotropy = -0.3;
    fog.backShare = 0.25;
    fog.octaves = 2;
    fog.ambient = glm::dvec3(0.02);
    return fog;
}

RenderOptions seenFrom(Projection projection) {
    RenderOptions options;
    options.camera.direction = glm::dvec3(-0.5, -0.4, -1);
    options.camera.projection = projection;
    options.camera.sizePixels = {48, 48};
    if (projection == Projection::kPerspective) {
        options.camera.fovDegrees = 50;
        options.camera.distanceWorld = 60;
    }
    if (projection == Projection::kLatlong) {
        options.camera.eyeWorld = glm::dvec3(4, -3, 12);
        options.camera.sizePixels = {64, 32};
    }
    return options;
}

// In decibels of the brightest.
double agreementOf(const Volume& volume, const RenderOptions& options, const Ball& ball,
                   double voxel) {
    const RenderResult result = render(volume, options);
    double squares = 0;
    double brightest = 0;
    int pixels = 0;
    for (int y = 0; y < options.camera.sizePixels.y; y += 3) {
        for (int x = 0; x < options.camera.sizePixels.x; x += 3) {
            const auto line = test::sightLineOf(result.camera, {x + 0.5, y + 0.5}, 100);
            const double expected = radianceOf(ball, *options.optics.scattering, line, voxel);
            squares += std::pow(redOf(result.image, x, y) - expected, 2);
            brightest = std::max(brightest, expected);
            ++pixels;
        }
    }
    EXPECT_GT(brightest, 0.2);
    return 20 * std::log10(brightest / std::sqrt(squares / pixels));
}

// In the middle, beside it, and outside, beside light from far away.
TEST(PointLight, inASmoothBallIsWhatWaysShow) {
    const Ball ball{0.12, 9};
    const Volume volume = fogOf(glm::ivec3(128), aroundMiddle(128, 0.5),
                                [&](const auto& p) { return ball.extinctionAt(p); });
    const std::vector<std::vector<Light>> lights = {
        {pointAt({0, 0, 0}, 150, 4)},
        {pointAt({9.1, 7.3, -4.2}, 100, 3, {1, 0.5, 0.2})},
        {pointAt({25, 30, 12}, 1500), {LightFrame::kWorld, {1, -2, -0.7}, {2, 1.5, 1}, 0.5}},
    };
    for (const std::vector<Light>& some : lights) {
        for (const Projection projection :
             {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
            RenderOptions options = seenFrom(projection);
            options.optics = fogOptics(someFog());
            options.optics.scattering->lights = some;
            const bool isAlone = some.size() == 1;
            EXPECT_GT(agreementOf(volume, options, ball, 0.5), isAlone ? 55 : 45)
                << projectionName(projection);
        }
    }
}

// Of the sum that light and view leave of what comes from h before or behind a slab of 24 units.
TEST(PointLight, onASlabIsTheSumOverItsDepth) {
    constexpr double kAway = 9;
    const auto radiance = [](double extinction, double z) {
        glm::dmat4 world(0.5);
        world[3] = {-11.75, -11.75, 0.25, 1};
        const Volume volume = fogOf(glm::ivec3(48), world, [&](const auto&) { return extinction; });
        Scattering fog;
        fog.lights = {pointAt({0, 0, z}, 300)};
        RenderOptions options;
        options.optics = fogOptics(fog);
        options.camera.direction = glm::dvec3(0, 0, -1);
        options.camera.sizePixels = {33, 33};
        return redOf(render(volume, options).image, 16, 16);
    };
    for (const double extinction : {0.01, 0.1, 1.0}) {
        double before = 0;
        double behind = 0;
        constexpr double kStep = 0.001;
        for (double t = kStep / 2; t < 24; t += kStep) {
            const double seen = kStep * extinction * std::exp(-extinction * t) * 300 / 4;
            before += seen * std::exp(-extinction * t) / std::pow(kAway + t, 2);
            behind += seen * std::exp(-extinction * (24 - t)) / std::pow(kAway + 24 - t, 2);
        }
        EXPECT_NEAR(radiance(extinction, 24 + kAway) / before, 1, 0.02) << extinction;
        EXPECT_NEAR(radiance(extinction, -kAway), behind, 0.02 * behind + 1e-4) << extinction;
    }
}

// By the square of the distance, also where that leaves a hundred-millionth of what is brightest:
// in the light's own voxel.
TEST(PointLight, growsWeakerWithTheSquareOfTheDistance) {
    constexpr int kFar = 4000;
    glm::dmat4 world(1.0);
    world[3] = {0, -2, 0, 1};
    const Volume volume = fogOf({kFar + 1, 5, 1}, world, [](const auto&) { return 1e-7; });
    Scattering fog;
    fog.lights = {pointAt({0, 0, 0}, 1e6)};
    RenderOptions options;
    options.optics = fogOptics(fog);
    options.camera.sizePixels = {kFar, 5};
    options.camera.frameWidthWorld = kFar;
    options.camera.targetWorld = glm::dvec3(0.5 * kFar, 0, 0);
    const Image image = render(volume, options).image;
    for (int x = 20; x < kFar - 10; x += 30) {
        const double expected = 1e-7 * 1e6 / 4 / std::pow(x + 0.5, 2);
        EXPECT_NEAR(redOf(image, x, 2) / expected, 1, 0.015) << x;
    }
}

TEST(PointLight, fromFarAwayIsThatOfOneDirection) {
    const Ball ball{0.12, 9};
    const Volume volume = fogOf(glm::ivec3(64), aroundMiddle(64, 1),
                                [&](const auto& p) { return ball.extinctionAt(p); });
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, -2, -0.7));
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        RenderOptions options = seenFrom(projection);
        options.optics = fogOptics(someFog());
        options.optics.scattering->lights = {{LightFrame::kWorld, way, glm::dvec3(1), 2}};
        const Image parallel = render(volume, options).image;
        const double brightest = *std::max_element(parallel.rgba.begin(), parallel.rgba.end());
        for (const double away : {1e4, 7e5}) {
            Light& light = options.optics.scattering->lights[0];
            light = pointAt(-away * way, 1e6, 0, glm::dvec3(2e-6 * away * away));
            const Image image = render(volume, options).image;
            EXPECT_NEAR(meanOf(image) / meanOf(parallel), 1, 0.002);
            for (std::size_t i = 0; i < image.rgba.size(); ++i)
                EXPECT_NEAR(image.rgba[i], parallel.rgba[i], 0.01 * brightest);
        }
    }
}

// What leaves a thin ball of radius 8 about the light, to one side: of light of strength S, pi S
// times what is scattered, however the light stands among voxels, and however large these are. And
// never more, however dense the ball is.
TEST(PointLight, sendsOnNoMoreThanItIs) {
    constexpr double kRadius = 8;
    const auto sentOn = [](double extinction, double voxel, const glm::dvec3& light,
                           double radius) {
        const int n = 2 * int(std::ceil(kRadius / voxel)) + 5;
        const Volume volume = fogOf(glm::ivec3(n), aroundMiddle(n, voxel), [&](const auto& p) {
            return glm::distance(p, light) < kRadius ? extinction : 0;
        });
        Scattering fog;
        fog.lights = {pointAt(light, 1, radius)};
        RenderOptions options;
        options.optics = fogOptics(fog);
        options.camera.direction = glm::dvec3(-0.5, -0.4, -1);
        options.camera.sizePixels = {64, 64};
        options.camera.frameWidthWorld = 24;
        return meanOf(render(volume, options).image) * 24 * 24;
    };
    constexpr double kThin = 1e-3;
    for (const double voxel : {0.5, 1.0, 2.0}) {
        for (const glm::dvec3& light :
             {glm::dvec3(0), {0.5, 0.5, 0.5}, {0.25, 0.5, 0}, {0.1, 0.2, -0.3}}) {
            const double expected = kPi * kThin * kRadius;
            // Of few voxels each is lit as its middle is, but for the light's own.
            EXPECT_NEAR(sentOn(kThin, voxel, voxel * light, 0) / expected, 1, 0.02 + 0.045 * voxel)
                << voxel << " " << light.x;
        }
    }
    // Within the light's radius it is as at the radius: a third of it.
    EXPECT_NEAR(sentOn(kThin, 0.5, {0, 0, 0}, 6) / kPi / kThin, 6.0 / 3 + 2, 0.1);
    for (const double extinction : {0.03, 0.1, 1.0, 10.0, 1e3}) {
        for (const double radius : {0.0, 2.0})
            EXPECT_LT(sentOn(extinction, 0.5, {0.2, 0.1, 0}, radius), kPi) << extinction;
    }
}

// Who knows how fog is lit in one shape, knows it in all.
TEST(PointLight, doesNotDependOnVoxels) {
    const Ball ball{0.15, 6};
    const auto imageOf = [&](const glm::dmat3& shape) {
        const int n = 72;
        glm::dmat4 world(shape);
        world[3] = glm::dvec4(shape * glm::dvec3(-0.5 * (n - 1)), 1);
        const Volume volume =
            fogOf(glm::ivec3(n), world, [&](const auto& p) { return ball.extinctionAt(p); });
        RenderOptions options = seenFrom(Projection::kOrtho);
        options.optics = fogOptics(someFog());
        options.optics.scattering->lights = {pointAt({5, 8, 3}, 80, 3)};
        options.camera.targetWorld = glm::dvec3(0);
        options.camera.up = glm::dvec3(0, 1, 0);
        options.camera.frameWidthWorld = 40;
        return render(volume, options).image;
    };
    const Image upright = imageOf(glm::dmat3(0.6));
    for (const glm::dmat3& shape : {glm::dmat3({0.36, -0.48, 0}, {0.48, 0.36, 0}, {0, 0, -0.6}),
                                    glm::dmat3({0.6, 0.15, 0}, {0, 0.7, -0.2}, {0.1, 0, 0.55})}) {
        const Image image = imageOf(shape);
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            EXPECT_NEAR(image.rgba[i], upright.rgba[i], 0.02);
    }
}

Volume someFogVolume() {
    const Ball ball{0.3, 5};
    glm::dmat4 world(glm::dmat3({0.9, 0.1, 0}, {-0.1, 1.1, 0.2}, {0, 0, 1.3}));
    world[3] = {-14, -15, -18, 1};
    return fogOf({31, 29, 27}, world, [&](const glm::dvec3& p) {
        const double holes = std::sin(p.x) * std::sin(1.3 * p.y) * std::cos(0.8 * p.z);
        return holes > 0.2 ? 0 : ball.extinctionAt(p);
    });
}

RenderOptions someOptions() {
    RenderOptions options;
    options.optics = fogOptics(someFog());
    options.optics.scattering->lights = {
        pointAt({1, -2, 0.7}, 40),
        pointAt({-14, 3, 20}, 300, 1, {0.3, 0.5, 1}),
        {LightFrame::kWorld, {-0.8, -0.1, -2}, {0.3, 0.2, 0.1}, 1}};
    options.camera.direction = glm::dvec3(-0.3, -0.4, -1);
    options.camera.sizePixels = {64, 64};
    return options;
}

// Bit for bit: a world turned inside out. (Of voxels in the opposite order this is not so: sums are
// then added in another.)
TEST(PointLight, mirrorsWithTheScene) {
    Volume volume = someFogVolume();
    RenderOptions options = someOptions();
    options.camera.targetWorld = glm::dvec3(1, 2, 0);
    options.camera.frameWidthWorld = 50;
    const Image image = render(volume, options).image;
    EXPECT_GT(meanOf(image), 0.01);
    for (int i = 0; i < 4; ++i)
        test::changed(volume)->worldFromIndex[i].x = -volume.worldFromIndex()[i].x;
    options.camera.direction->x = -options.camera.direction->x;
    options.camera.targetWorld->x = -options.camera.targetWorld->x;
    for (Light& light : options.optics.scattering->lights) {
        light.direction.x *= -1;
        if (light.positionWorld) light.positionWorld->x *= -1;
    }
    EXPECT_EQ(test::mirrored(render(volume, options).image).rgba, image.rgba);
}

TEST(PointLight, isTheSameHoweverItIsMade) {
    RenderOptions options = someOptions();
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        options.camera.projection = projection;
        test::expectTheSameHoweverItIsMade(someFogVolume(), options);
    }
}

TEST(PointLight, ofAPreparedSceneIsThatOfRender) {
    test::expectPreparedIsTheSame(std::make_shared<const Volume>(someFogVolume()), someOptions());
}

// Constant blocks that are stored as such, and where a volume's indices begin, are all the same.
TEST(PointLight, doesNotDependOnHowFogIsStored) {
    const auto pictureOf = [](const glm::ivec3& first, bool asTiles, const glm::dvec3& light) {
        Volume volume = test::makeVolume({first, first + 31}, [&](int x, int y, int z) {
            const glm::ivec3 p = (glm::ivec3(x, y, z) - first) / 8;
            return 20 + 10 * (p.x + p.y * p.z);
        });
        if (asTiles) {
            auto tree = std::make_shared<CodeTree>(*volume.codes());
            tree->tree().prune();
            EXPECT_GT(tree->tree().activeTileCount(), 0u);
            test::changed(volume)->codes = tree;
        }
        test::changed(volume)->worldFromIndex[3] = glm::dvec4(-glm::dvec3(first), 1);
        RenderOptions options = someOptions();
        options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.2, 0.5, 0}};
        options.optics.scattering->lights = {pointAt(light, 100, 2)};
        return render(volume, options).image;
    };
    for (const glm::dvec3& light : {glm::dvec3(16, 16, 16), {-3, 12, 40.5}, {8, 15.5, 7}}) {
        const Image image = pictureOf({0, 0, 0}, false, light);
        EXPECT_GT(meanOf(image), 0.01);
        EXPECT_EQ(pictureOf({0, 0, 0}, true, light).rgba, image.rgba);
        const Image moved = pictureOf({-100003, 77, 13}, false, light);
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            EXPECT_NEAR(moved.rgba[i], image.rgba[i], 2e-3);
    }
}

// Wherever it stands, pictures are of numbers, and nothing is brighter than what the light is.
TEST(PointLight, mayStandAnywhere) {
    const Volume volume = someFogVolume();
    for (const glm::dvec3& light : {glm::dvec3(-14, -15, -18),
                                    {-13.1, -14.9, -18},
                                    {0, 0, 0},
                                    {1e30, -1e30, 1e30},
                                    {1e-30, 0, 0},
                                    {1e12, 0, 0},
                                    {3, 40, -5}}) {
        for (const double radius : {0.0, 1e-30, 1.0, 1e30}) {
            for (const Projection projection :
                 {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
                RenderOptions options = seenFrom(projection);
                options.optics = fogOptics(someFog());
                options.optics.scattering->anisotropy = 0.99;
                options.optics.scattering->lights = {pointAt(light, 1e6, radius)};
                const Image image = render(volume, options).image;
                for (const float channel : image.rgba) {
                    ASSERT_TRUE(std::isfinite(channel));
                    ASSERT_GE(channel, 0);
                }
            }
        }
    }
}

TEST(PointLight, refusesWhatCannotBe) {
    const Volume volume = someFogVolume();
    const auto errorWith = [&](const auto& change) {
        RenderOptions options = someOptions();
        change(options, options.optics.scattering->lights[0]);
        return errorOf([&] { render(volume, options); });
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.positionWorld->y = kNan; }),
              "usage: `scattering.lights` position: got 1,nan,0.7; expected numbers from -1e30 to "
              "1e30");
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.positionWorld->x = -1e31; }),
              "usage: `scattering.lights` position: got -1e+31,-2,0.7; expected numbers from -1e30 "
              "to 1e30");
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.radiusWorld = -1; }),
              "usage: `scattering.lights` radius: got -1; expected a number within 0..1e30");
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.radiusWorld = kNan; }),
              "usage: `scattering.lights` radius: got nan; expected a number within 0..1e30");
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.strength = -1; }),
              "usage: `scattering.lights` strength: got -1; expected a number within 0..1e6");
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.frame = LightFrame::kView; }),
              "usage: `scattering.lights`: got one that moves with the camera; expected lights of "
              "the world");
    EXPECT_EQ(errorWith([](RenderOptions& options, Light& light) {
                  options.optics.shading = Shading{};
                  options.optics.shading->lights = {light};
                  options.optics.scattering.reset();
              }),
              "usage: `shading.lights`: got a point light; expected lights from far away, as "
              "without `scattering`");
    // Of no effect, it may be anything.
    EXPECT_EQ(errorWith([](auto&, Light& light) { light.direction = glm::dvec3(0); }), "no error");
}

}  // namespace
}  // namespace deltasplat
