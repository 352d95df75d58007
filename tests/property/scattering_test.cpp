// SPDX-License-Identifier: Apache-2.0
// Fog that scatters light, against closed forms, and what must stay the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "lighting/scatter_kernels.h"
#include "support/error_of.h"
#include "support/lit_fog.h"
#include "support/make_volume.h"
#include "support/mirrored.h"
#include "support/same_picture.h"
#include "support/sight_line.h"

namespace deltasplat {
namespace {

using test::Ball;
using test::errorOf;
using test::fogOf;
using test::fogOptics;
using test::henyeyGreenstein;
using test::kPi;
using test::mirrored;
using test::phaseOf;
using test::sightLineOf;

Light sunOf(const glm::dvec3& direction, const glm::dvec3& color = glm::dvec3(1)) {
    return {LightFrame::kWorld, direction, color, 1};
}

glm::dvec4 pixelOf(const Image& image, int x, int y) {
    const float* rgba = image.pixel(x, y);
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

glm::dvec4 middleOf(const Image& image) {
    return pixelOf(image, image.size.x / 2, image.size.y / 2);
}

double meanOf(const Image& image, int channel) {
    double sum = 0;
    for (std::size_t i = std::size_t(channel); i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return 4 * sum / double(image.rgba.size());
}

// Red, of light that comes along a line of sight: by the formulas of the documentation.
double radianceOf(const Ball& ball, const Scattering& fog, const glm::dvec3& start,
                  const glm::dvec3& ray) {
    constexpr double kStep = 0.25;
    double sum = 0;
    double seen = 0;  // extinction in front
    for (double t = kStep / 2; t < 200; t += kStep) {
        const glm::dvec3 p = start + t * ray;
        const double extinction = ball.extinctionAt(p);
        double light = fog.ambient.x;
        for (const Light& one : fog.lights) {
            const glm::dvec3 way = glm::normalize(one.direction);
            for (int i = 0; i <= fog.octaves; ++i) {
                light += kPi * one.strength * one.color.x * std::pow(0.5 * fog.albedo.x, i) *
                         phaseOf(fog, i, glm::dot(way, -ray)) *
                         std::exp(-ball.depthAt(p, way) * std::pow(0.5, i));
            }
        }
        sum += std::exp(-seen - extinction * kStep / 2) * -std::expm1(-extinction * kStep) *
               fog.albedo.x * light;
        seen += extinction * kStep;
    }
    return sum;
}

Scattering someFog() {
    Scattering fog;
    fog.albedo = glm::dvec3(0.9, 0.8, 0.7);
    fog.anisotropy = 0.6;
    fog.backAnisotropy = -0.3;
    fog.backShare = 0.25;
    fog.octaves = 2;
    fog.ambient = glm::dvec3(0.02);
    fog.lights = {sunOf({1, -2, -0.7}, {2, 1.5, 1}), sunOf({-0.8, -0.1, -2}, {0.3, 0.5, 1})};
    return fog;
}

TEST(Scattering, ofASmoothBallIsTheClosedForm) {
    const Ball ball{0.12, 9};
    glm::dmat4 world(0.5);
    world[3] = {-31.75, -31.75, -31.75, 1};
    const Volume volume =
        fogOf(glm::ivec3(128), world, [&](const auto& p) { return ball.extinctionAt(p); });
    const Scattering fog = someFog();
    for (const Projection projection :
         {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
        RenderOptions options;
        options.optics = fogOptics(fog);
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
        const RenderResult result = render(volume, options);
        const Camera& camera = result.camera;
        double squares = 0;
        int pixels = 0;
        double brightest = 0;
        for (int y = 0; y < options.camera.sizePixels.y; y += 3) {
            for (int x = 0; x < options.camera.sizePixels.x; x += 3) {
                const glm::dvec2 pixel(x + 0.5, y + 0.5);
                const auto [start, ray] = sightLineOf(camera, pixel, 100);
                const double expected = radianceOf(ball, fog, start, ray);
                const double off = result.image.pixel(x, y)[0] - expected;
                squares += off * off;
                ++pixels;
                brightest = std::max(brightest, expected);
            }
        }
        EXPECT_GT(brightest, 0.2);
        EXPECT_GT(20 * std::log10(brightest / std::sqrt(squares / pixels)), 43)
            << projectionName(projection);
    }
}

// A slab across the line of sight, of 24 world units.
Volume slabOf(double extinction, double voxel) {
    const int n = int(std::lround(24 / voxel));
    glm::dmat4 world(voxel);
    world[3] = {0, 0, voxel / 2, 1};
    return fogOf({n, n, n}, world, [&](const auto&) { return extinction; });
}

double slabRadiance(double extinction, double voxel, const Scattering& fog) {
    RenderOptions options;
    options.optics = fogOptics(fog);
    options.camera.direction = glm::dvec3(0, 0, -1);
    options.camera.sizePixels = {33, 33};
    return middleOf(render(slabOf(extinction, voxel), options).image).r;
}

// A quarter of the light, dimmed on both ways: however dense, up to what is opaque.
TEST(Scattering, ofASlabIsTheClosedForm) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double extinction : {1.0, 5.0, 50.0, kInfinity}) {
        for (const double voxel : {1.0, 0.5}) {
            Scattering fog;
            fog.lights = {sunOf({0, 0, -1})};
            EXPECT_NEAR(slabRadiance(extinction, voxel, fog), 0.125, 1e-3) << extinction;
            fog.lights = {sunOf({0, 0, 1})};
            EXPECT_LT(slabRadiance(extinction, voxel, fog), 1e-4) << extinction;
        }
    }
    for (const double extinction : {0.002, 0.02, 0.1}) {
        const double depth = 24 * extinction;
        for (const double voxel : {1.0, 0.5}) {
            Scattering fog;
            fog.lights = {sunOf({0, 0, -3})};
            EXPECT_NEAR(slabRadiance(extinction, voxel, fog), 0.25 * -std::expm1(-2 * depth) / 2,
                        0.003 * depth)
                << extinction;
            fog.lights = {sunOf({0, 0, 1})};
            EXPECT_NEAR(slabRadiance(extinction, voxel, fog), 0.25 * depth * std::exp(-depth),
                        0.003 * depth)
                << extinction;
        }
    }
}

TEST(Scattering, octavesAreWhatIsWritten) {
    Scattering fog;
    fog.anisotropy = 0.5;
    fog.octaves = 8;
    fog.lights = {sunOf({0, 0, 1})};
    const double depth = 24 * 0.3;
    for (const double albedo : {1.0, 0.5}) {
        fog.albedo = glm::dvec3(albedo);
        double expected = 0;
        for (int i = 0; i <= 8; ++i) {
            const double part = std::pow(0.5, i);
            // From behind: exp(-part * (depth - t)) exp(-t), over t.
            const double way = i == 0 ? depth * std::exp(-depth)
                                      : (std::exp(-part * depth) - std::exp(-depth)) / (1 - part);
            expected +=
                std::pow(albedo, i + 1) * part * kPi * henyeyGreenstein(0.5 * part, 1) * way;
        }
        EXPECT_NEAR(slabRadiance(0.3, 0.5, fog), expected, 0.01 * expected);
    }
}

// Whether the albedo, the transfer function or a grid of colours swallows light: as often as it is
// scattered. What sends on more than it gets does so but once.
TEST(Scattering, swallowsEachTime) {
    const Ball ball{0.25, 5};
    const Volume volume = fogOf(glm::ivec3(32), test::aroundMiddle(32, 1),
                                [&](const auto& p) { return ball.extinctionAt(p); });
    const auto same = std::make_shared<const Volume>(
        fogOf(glm::ivec3(32), test::aroundMiddle(32, 1), [](const auto&) { return std::log(2); }));
    ASSERT_NEAR(same->valueMax(), 0.5, 1e-6);
    Scattering fog = someFog();
    fog.ambient = glm::dvec3(0);
    fog.albedo = glm::dvec3(0.5);
    fog.lights.push_back(test::pointAt({3, 1, 2}));
    fog.lights.back().strength = 30;
    RenderOptions options;
    options.camera.view = "iso";
    options.camera.sizePixels = {32, 32};
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        options.camera.projection = projection;
        options.optics = fogOptics(fog);
        options.optics.transferFunction.linearColors = true;
        const Image byAlbedo = render(volume, options).image;
        options.optics.scattering->albedo = glm::dvec3(1);
        const Image white = render(volume, options).image;
        options.optics.transferFunction.colors = {{0, glm::dvec3(0.5)}};
        const Image byFunction = render(volume, options).image;
        options.optics.transferFunction.colors = {{0, glm::dvec3(1)}};
        options.optics.colorGrids = ColorGrids{same, same, same};
        const Image byGrid = render(volume, options).image;
        options.optics.colorGrids.reset();
        options.optics.transferFunction.colors = {{0, glm::dvec3(2)}};
        const Image bright = render(volume, options).image;
        const double brightest = *std::max_element(byAlbedo.rgba.begin(), byAlbedo.rgba.end());
        const double most = 2e-3 * brightest;
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                const double red = pixelOf(byAlbedo, x, y).r;
                EXPECT_NEAR(pixelOf(byFunction, x, y).r, red, most);
                EXPECT_NEAR(pixelOf(byGrid, x, y).r, red, most);
                EXPECT_NEAR(pixelOf(bright, x, y).r, 2 * pixelOf(white, x, y).r, 4 * most);
            }
        }
        EXPECT_LT(meanOf(byAlbedo, 0), 0.45 * meanOf(white, 0));
    }
}

TEST(Scattering, phasesAddUpToOne) {
    Scattering fog = someFog();
    fog.octaves = kMostOctaves;
    const std::vector<ScatterPhase> phases = phasesOf(fog);
    ASSERT_EQ(phases.size(), 9u);
    for (int i = 0; i <= fog.octaves; ++i) {
        constexpr int kSteps = 20000;
        double sum = 0;
        double most = 0;
        for (int step = 0; step < kSteps; ++step) {
            const double cosine = -1 + 2 * (step + 0.5) / kSteps;
            const double share = phases[std::size_t(i)].at(cosine);
            EXPECT_NEAR(share, kPi * std::pow(0.5, i) * phaseOf(fog, i, cosine), 1e-6);
            sum += share * 2 * kPi * 2 / kSteps;
            most = std::max(most, share);
        }
        // In units of pi, and of 2^-i.
        EXPECT_NEAR(sum / kPi * std::pow(2.0, i), 1, 1e-5);
        EXPECT_LE(most, phases[std::size_t(i)].largest() * (1 + 1e-6));
    }
}

// White fog, lit from all sides by a sky of radiance 1, is nowhere brighter than the sky.
TEST(Scattering, isNeverBrighterThanTheLight) {
    Scattering fog;
    constexpr int kLights = 64;
    for (int i = 0; i < kLights; ++i) {
        const double z = -1 + (2 * i + 1.0) / kLights;
        const double angle = i * kPi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        fog.lights.push_back(
            sunOf({r * std::cos(angle), r * std::sin(angle), z}, glm::dvec3(4.0 / kLights)));
    }
    const Ball ball{0.4, 5};
    glm::dmat4 world(1.0);
    world[3] = {-15.5, -15.5, -15.5, 1};
    const Volume volume =
        fogOf(glm::ivec3(32), world, [&](const auto& p) { return ball.extinctionAt(p); });
    RenderOptions options;
    options.camera.view = "iso";
    options.camera.sizePixels = {48, 48};
    // Thin, it scatters all of the light that it meets.
    for (const double scale : {0.01, 1.0}) {
        options.optics = fogOptics(fog);
        options.optics.extinctionScale = scale;
        const Image image = render(volume, options).image;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 48; ++x) {
                const glm::dvec4 seen = pixelOf(image, x, y);
                EXPECT_LE(seen.r, seen.a * 1.01 + 1e-6);
                if (scale < 1 && seen.a > 1e-3) {
                    EXPECT_GE(seen.r, 0.9 * seen.a);
                }
            }
        }
    }
    // What leaves a slab that is lit straight, to both sides, is no more than what came: with
    // octaves as well. Integrated over all directions.
    for (const int octaves : {0, 4, 8}) {
        Scattering even;
        even.octaves = octaves;
        const std::vector<ScatterPhase> phases = phasesOf(even);
        for (const double depth : {0.1, 0.5, 1.0, 3.0, 10.0, 100.0}) {
            double power = 0;  // of pi that come
            for (int i = 0; i < 40; ++i) {
                const double cosine = (i + 0.5) / 40;
                for (int octave = 0; octave <= octaves; ++octave) {
                    const double part = std::pow(0.5, octave);
                    const double towards = 1 / cosine + part;
                    const double away = 1 / cosine - part;
                    const double back = -std::expm1(-towards * depth) / towards;
                    const double on =
                        std::abs(away) < 1e-9
                            ? depth * std::exp(-part * depth)
                            : (std::exp(-part * depth) - std::exp(-depth / cosine)) / away;
                    // Radiance times cosine over the two half-spheres, of light of irradiance pi.
                    power += phases[std::size_t(octave)].at(0) * (back + on) / cosine * cosine * 2 *
                             kPi / 40;
                }
            }
            EXPECT_LE(power, kPi) << octaves << " " << depth;
        }
    }
}

// What the camera and the light exchange is the same both ways, where fog scatters evenly.
TEST(Scattering, isTheSameBothWays) {
    const Ball ball{0.25, 5};
    glm::dmat4 world(1.0);
    world[3] = {-15.5, -13.5, -16.5, 1};
    const Volume volume = fogOf(glm::ivec3(32), world, [&](const glm::dvec3& p) {
        return p.x + 0.3 * p.y > 1 ? 0.4 * ball.extinctionAt(p) : ball.extinctionAt(p);
    });
    const auto seen = [&](const glm::dvec3& view, const glm::dvec3& light) {
        Scattering fog;
        fog.lights = {sunOf(light)};
        RenderOptions options;
        options.optics = fogOptics(fog);
        options.camera.direction = view;
        options.camera.frameWidthWorld = 64;
        options.camera.sizePixels = {64, 64};
        return meanOf(render(volume, options).image, 0);
    };
    const glm::dvec3 a(1, -0.6, -0.4);
    const glm::dvec3 b(-0.2, -0.5, -1);
    EXPECT_NEAR(seen(a, -b) / seen(b, -a), 1, 0.01);
}

// Slices along another axis, or half as thick, show the same within 1 %.
TEST(Scattering, doesNotDependOnSlices) {
    const Ball ball{0.1, 9};
    const auto imageOf = [&](double voxel, const glm::dvec3& direction) {
        glm::dmat4 world(voxel);
        const int n = int(64 / voxel);
        world[3] = glm::dvec4(glm::dvec3(-32 + voxel / 2), 1);
        const Volume volume =
            fogOf(glm::ivec3(n), world, [&](const auto& p) { return ball.extinctionAt(p); });
        RenderOptions options;
        options.optics = fogOptics(someFog());
        options.camera.direction = direction;
        options.camera.up = glm::dvec3(0, 1, 0);
        options.camera.frameWidthWorld = 64;
        options.camera.sizePixels = {64, 64};
        return render(volume, options).image;
    };
    const double coarse = meanOf(imageOf(1, {-1, -0.3, -0.7}), 0);
    EXPECT_NEAR(meanOf(imageOf(0.5, {-1, -0.3, -0.7}), 0) / coarse, 1, 0.01);
    // Just on either side of where the slice axis changes.
    const Image one = imageOf(1, {-1, -0.3, -0.9999});
    const Image other = imageOf(1, {-0.9999, -0.3, -1});
    EXPECT_NEAR(meanOf(one, 0) / meanOf(other, 0), 1, 0.001);
    for (std::size_t i = 0; i < one.rgba.size(); ++i) EXPECT_NEAR(one.rgba[i], other.rgba[i], 0.01);
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
    options.camera.direction = glm::dvec3(-0.3, -0.4, -1);
    options.camera.sizePixels = {64, 64};
    return options;
}

// Bit for bit: a world turned inside out.
TEST(Scattering, mirrorsWithTheScene) {
    Volume volume = someFogVolume();
    RenderOptions options = someOptions();
    options.camera.targetWorld = glm::dvec3(1, 2, 0);
    options.camera.frameWidthWorld = 50;
    Volume other = volume;
    for (int i = 0; i < 4; ++i)
        test::changed(other)->worldFromIndex[i].x = -other.worldFromIndex()[i].x;
    RenderOptions fromThere = options;
    fromThere.camera.direction->x = -fromThere.camera.direction->x;
    fromThere.camera.targetWorld->x = -fromThere.camera.targetWorld->x;
    for (Light& light : fromThere.optics.scattering->lights) light.direction.x *= -1;
    for (const Projection projection :
         {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
        for (CameraOptions* camera : {&options.camera, &fromThere.camera}) {
            camera->projection = projection;
            if (projection != Projection::kOrtho) camera->frameWidthWorld.reset();
            if (projection == Projection::kLatlong) {
                camera->eyeWorld = camera->targetWorld;
                camera->targetWorld.reset();
                camera->sizePixels = {96, 48};
            }
        }
        const Image image = render(volume, options).image;
        EXPECT_GT(meanOf(image, 0), 0.01);
        EXPECT_EQ(mirrored(render(other, fromThere).image).rgba, image.rgba)
            << projectionName(projection);
    }
}

TEST(Scattering, isTheSameHoweverItIsMade) {
    RenderOptions options = someOptions();
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        options.camera.projection = projection;
        test::expectTheSameHoweverItIsMade(someFogVolume(), options);
    }
}

TEST(Scattering, ofAPreparedSceneIsThatOfRender) {
    test::expectPreparedIsTheSame(std::make_shared<const Volume>(someFogVolume()), someOptions());
}

// As from far away as it may be, from an eye: what hardly reaches the camera beside what would.
TEST(Scattering, fromFarAwayIsParallel) {
    Scattering fog;
    fog.anisotropy = 0.99;
    fog.lights = {{LightFrame::kWorld, {1, 0, 0.1}, glm::dvec3(1), 4000}};
    RenderOptions options;
    options.optics = fogOptics(fog);
    options.camera.sizePixels = {32, 32};
    options.camera.direction = glm::dvec3(0, 0, -1);
    options.camera.frameWidthWorld = 24;
    const Volume volume = slabOf(0.001, 1);
    const glm::dvec4 parallel = middleOf(render(volume, options).image);
    EXPECT_GT(parallel.r, 1e-3);
    options.camera.projection = Projection::kPerspective;
    options.camera.frameWidthWorld.reset();
    options.camera.eyeWorld = glm::dvec3(11.5, 11.5, 2e5);
    options.camera.targetWorld = glm::dvec3(11.5, 11.5, 12);
    options.camera.direction.reset();
    options.camera.fovDegrees = 360 / kPi * std::atan(12 / 2e5);
    EXPECT_NEAR(middleOf(render(volume, options).image).r / parallel.r, 1, 0.02);
}

// Constant blocks that are stored as such, and where a volume's indices begin, are all the same.
TEST(Scattering, doesNotDependOnHowItIsStored) {
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
        options.optics.scattering->lights = {sunOf(light)};
        return render(volume, options).image;
    };
    for (const glm::dvec3& light :
         {glm::dvec3(0, 0, 1), glm::dvec3(-1, 1, 1), glm::dvec3(0.3, -1, 0.2)}) {
        const Image image = pictureOf({0, 0, 0}, false, light);
        EXPECT_GT(meanOf(image, 0), 0.01);
        EXPECT_EQ(pictureOf({0, 0, 0}, true, light).rgba, image.rgba);
        const Image moved = pictureOf({-100003, 77, 13}, false, light);
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            EXPECT_NEAR(moved.rgba[i], image.rgba[i], 2e-4);
    }
}

// Of any length.
TEST(Scattering, takesWaysOfAnyLength) {
    const Volume volume = someFogVolume();
    const auto pictureOf = [&](double length) {
        RenderOptions options = someOptions();
        options.optics.scattering->lights = {sunOf({-length, -length, 0})};
        return render(volume, options).image.rgba;
    };
    const std::vector<float> one = pictureOf(1);
    EXPECT_EQ(pictureOf(1e-200), one);
    EXPECT_EQ(pictureOf(1e300), one);
}

TEST(Scattering, refusesWhatCannotBe) {
    const Volume volume = someFogVolume();
    const auto errorWith = [&](const auto& change) {
        RenderOptions options = someOptions();
        change(options);
        return errorOf([&] { render(volume, options); });
    };
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->albedo.y = 1.5; }),
              "usage: `scattering.albedo`: got 0.9,1.5,0.7; expected numbers within "
              "0..1");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->anisotropy = 1; }),
              "usage: `scattering.anisotropy`: got 1; expected a number within -0.99..0.99");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->backShare = -1; }),
              "usage: `scattering.backShare`: got -1; expected a number within 0..1");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->octaves = 9; }),
              "usage: `scattering.octaves`: got 9; expected a whole number within 0..8");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->lights[0].direction = glm::dvec3(0); }),
              "usage: `scattering.lights` direction: got 0,0,0; expected not all 0");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->lights[0].frame = LightFrame::kHead; }),
              "usage: `scattering.lights`: got one that moves with the camera; expected lights of "
              "the world");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.shading = Shading{}; }),
              "usage: `scattering`: got `shading` besides; expected one of the two");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.surface = Surface{}; }),
              "usage: `scattering`: got `surface` besides; expected one of the two");
    EXPECT_EQ(errorWith([](auto& o) {
                  o.optics.gradientOpacity = {{0, 1}};
              }),
              "usage: `scattering`: got `gradientOpacity` besides; expected one of the two");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.colorBy = ColorBy::kX; }),
              "usage: `scattering`: got `colorBy` x besides; expected `colorBy` value");
    EXPECT_EQ(errorWith([](auto& o) { o.optics.scattering->ambient.y = -1; }),
              "usage: `scattering.ambient`: got -1; expected a number within 0..1e6");
    EXPECT_EQ(errorWith([](auto& o) { o.splat.between = 1; }),
              "usage: `between`: got 1 with `scattering`; expected 0: lit fog and media of several "
              "grids are drawn by whole voxels");
}

}  // namespace
}  // namespace deltasplat
