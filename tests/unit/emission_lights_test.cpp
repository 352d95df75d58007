// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/optics/emission_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::errorOf;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kOrange(1, 0.5, 0.2);

// Values at voxels of one size about the middle of the world; what is 0 is not there.
std::shared_ptr<const Volume> volumeOf(
    const glm::ivec3& dims, const glm::dvec3& voxel,
    const std::function<double(const glm::dvec3& world)>& valueAt,
    const glm::dvec3& middle = glm::dvec3(0)) {
    MemoryLayout layout;
    layout.dims = dims;
    layout.background = 0;
    for (int axis = 0; axis < 3; ++axis) layout.worldFromIndex[axis][axis] = voxel[axis];
    layout.worldFromIndex[3] = glm::dvec4(middle - 0.5 * voxel * (glm::dvec3(dims) - 1.0), 1);
    std::vector<float> values;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const glm::dvec4 index(x, y, z, 1);
                values.push_back(float(valueAt(glm::dvec3(layout.worldFromIndex * index))));
            }
        }
    }
    return std::make_shared<const Volume>(makeVolume<float>(values, layout));
}

std::function<double(const glm::dvec3&)> ballOf(double radius,
                                                const glm::dvec3& middle = glm::dvec3(0)) {
    return [=](const glm::dvec3& p) { return glm::distance(p, middle) < radius ? 1 : 0; };
}

// Shines in one colour, 0.5 on a unit distance times the strength, where values are 1.
MediumPart fireOf(std::shared_ptr<const Volume> volume, const glm::dvec3& color = kOrange,
                  double strength = 3) {
    MediumPart part;
    part.volume = std::move(volume);
    part.kind = MediumPart::Kind::kEmission;
    part.transferFunction.colors = {{0, color}};
    part.transferFunction.linearColors = true;
    part.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 0.5, 0.5, 0}};
    part.strength = strength;
    return part;
}

Optics opticsOf(const std::vector<MediumPart>& parts) {
    Optics optics;
    optics.parts = parts;
    optics.unitDistance = 2;
    return optics;
}

// What all send out together for each direction: a light of strength 1 has pi.
glm::dvec3 intensityOf(const std::vector<Light>& lights) {
    glm::dvec3 sum(0);
    for (const Light& light : lights) sum += kPi * light.strength * light.color;
    return sum;
}

// Of what glows with 1.5 of orange on 2 world units.
glm::dvec3 intensityOfBall(double radius) {
    return 0.75 * kOrange * (4.0 / 3 * kPi * radius * radius * radius);
}

// On a plane that faces the origin.
glm::dvec3 irradianceAt(const std::vector<Light>& lights, const glm::dvec3& p) {
    glm::dvec3 sum(0);
    for (const Light& light : lights) {
        const glm::dvec3 away = p - *light.positionWorld;
        const double r = std::max(glm::length(away), light.radiusWorld);
        const double cosine = glm::dot(glm::normalize(away), glm::normalize(p));
        sum += kPi * light.strength * light.color * cosine / (r * r);
    }
    return sum;
}

void expectNear(const glm::dvec3& got, const glm::dvec3& expected, double share) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1, share);
}

TEST(EmissionLights, haveThePowerOfABall) {
    constexpr double kRadius = 14;
    for (const glm::dvec3& voxel : {glm::dvec3(1), {0.5, 0.8, 1.1}}) {
        const glm::ivec3 dims(glm::ceil(2 * kRadius / voxel) + 3.0);
        const auto ball = volumeOf(dims, voxel, ballOf(kRadius));
        for (const int count : {1, 2, 7, 40}) {
            const std::vector<Light> lights =
                emissionLights(*ball, opticsOf({fireOf(ball)}), count);
            EXPECT_EQ(lights.size(), std::size_t(count));
            expectNear(intensityOf(lights), intensityOfBall(kRadius), 0.01);
            // Of as many voxels exactly.
            const double voxels = double(ball->activeCount()) * voxel.x * voxel.y * voxel.z;
            expectNear(intensityOf(lights), 0.75 * kOrange * voxels, 1e-9);
        }
    }
}

// By Newton's shell theorem what shines evenly from a ball shines on planes outside, that face it,
// as if all came from its middle.
TEST(EmissionLights, shineAsABallDoes) {
    constexpr double kRadius = 14;
    const auto ball = volumeOf(glm::ivec3(32), glm::dvec3(1), ballOf(kRadius));
    for (const int count : {1, 5, 24, 200}) {
        const std::vector<Light> lights = emissionLights(*ball, opticsOf({fireOf(ball)}), count);
        for (const glm::dvec3& way :
             {glm::dvec3(1, 0, 0), {0, -1, 0}, {0.6, 0.64, 0.48}, {-0.36, 0.48, 0.8}}) {
            for (const double distance : {4.0, 20.0}) {
                const double r = distance * kRadius;
                expectNear(irradianceAt(lights, r * way), intensityOfBall(kRadius) / (r * r), 0.02);
            }
        }
    }
}

// One light is in its middle, and lights that as a ball does: by the integral of glow over all ways
// to it, 4 pi times the radius.
TEST(EmissionLights, areNoBrighterWithinThanFire) {
    constexpr double kRadius = 14;
    const glm::dvec3 middle(100, -50, 7);
    const auto ball = volumeOf(glm::ivec3(32), glm::dvec3(1), ballOf(kRadius, middle), middle);
    const std::vector<Light> lights = emissionLights(*ball, opticsOf({fireOf(ball)}), 1);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_LT(glm::distance(*lights[0].positionWorld, middle), 1e-9);
    const double radius = lights[0].radiusWorld;
    expectNear(intensityOf(lights) / (radius * radius), 4 * kPi * kRadius * 0.75 * kOrange, 0.02);
    // A single voxel has the radius that the volume's own voxel has (Scattering).
    const auto voxel = volumeOf(glm::ivec3(3), glm::dvec3(2), ballOf(0.1));
    const std::vector<Light> small = emissionLights(*voxel, opticsOf({fireOf(voxel)}), 5);
    ASSERT_EQ(small.size(), 1u);
    EXPECT_NEAR(small[0].radiusWorld, 0.358 * 2, 0.04);
}

// What lies apart has lights of its own.
TEST(EmissionLights, standWhereFireIs) {
    const glm::dvec3 left(-30, 4, 0);
    const glm::dvec3 right(33, -2, 5);
    const auto both = [&](const glm::dvec3& p) { return ballOf(6, left)(p) + ballOf(9, right)(p); };
    const auto volume = volumeOf({90, 30, 30}, glm::dvec3(1), both);
    const std::vector<Light> lights = emissionLights(*volume, opticsOf({fireOf(volume)}), 2);
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_LT(glm::distance(*lights[0].positionWorld, right), 0.1);
    EXPECT_LT(glm::distance(*lights[1].positionWorld, left), 0.1);
    expectNear(intensityOf({lights[1]}), intensityOfBall(6), 0.03);
    expectNear(lights[0].color, kOrange, 1e-6);
}

TEST(EmissionLights, haveThePowerOfBlackBodies) {
    constexpr double kKelvin = 1500;
    const auto ball = volumeOf(glm::ivec3(20), glm::dvec3(1), ballOf(8));
    MediumPart fire;
    fire.volume = ball;
    fire.kelvinScale = 1000;
    fire.kelvinOffset = 500;
    fire.strength = 2;
    const glm::dvec3 sum = intensityOf(emissionLights(*ball, opticsOf({fire}), 6));
    const double luminance = 0.2126 * sum.r + 0.7152 * sum.g + 0.0722 * sum.b;
    const double glow = 2 * 5.670374e-14 * std::pow(kKelvin, 4) / kPi;
    EXPECT_NEAR(luminance / (glow / 2 * double(ball->activeCount())), 1, 1e-3);
}

// Of grids that are coarser, finer or moved, and of several; of what swallows light nothing.
TEST(EmissionLights, areOfAllThatShines) {
    constexpr double kRadius = 12;
    const auto volume = volumeOf(glm::ivec3(32), glm::dvec3(1), ballOf(kRadius));
    for (const double voxel : {2.0, 0.4}) {
        const auto other = volumeOf(glm::ivec3(int(40 / voxel)), glm::dvec3(voxel),
                                    ballOf(kRadius, {3.3, -2, 1}), {3.3, -2, 1});
        const std::vector<Light> lights = emissionLights(*volume, opticsOf({fireOf(other)}), 3);
        expectNear(intensityOf(lights), intensityOfBall(kRadius), 0.02);
    }
    MediumPart smoke = fireOf(volume);
    smoke.kind = MediumPart::Kind::kAbsorption;
    EXPECT_TRUE(emissionLights(*volume, opticsOf({smoke}), 3).empty());
    EXPECT_TRUE(emissionLights(*volume, opticsOf({}), 3).empty());
    const std::vector<Light> lights = emissionLights(
        *volume, opticsOf({smoke, fireOf(volume, {0, 0, 1}), fireOf(volume, {1, 1, 0})}), 3);
    expectNear(intensityOf(lights), intensityOfBall(kRadius) / kOrange, 0.02);
    // Nothing of the volume itself shines.
    EXPECT_EQ(emissionLights(Volume(), opticsOf({fireOf(volume)}), 3).size(), 3u);
}

TEST(EmissionLights, areTheSameOnAnyNumberOfThreads) {
    const auto volume = test::someVolume();
    const Optics optics = test::someOptics(test::Colors::kFire);
    std::optional<ThreadLimit> threads(std::in_place, 1);
    const std::vector<Light> lights = emissionLights(*volume, optics, 9);
    ASSERT_EQ(lights.size(), 9u);
    threads.reset();
    threads.emplace(7);
    const std::vector<Light> again = emissionLights(*volume, optics, 9);
    ASSERT_EQ(again.size(), lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        EXPECT_EQ(again[i].positionWorld, lights[i].positionWorld);
        EXPECT_EQ(again[i].color, lights[i].color);
        EXPECT_EQ(again[i].strength, lights[i].strength);
        EXPECT_EQ(again[i].radiusWorld, lights[i].radiusWorld);
        if (i == 0) continue;
        EXPECT_LE(lights[i].strength, lights[i - 1].strength);
    }
}

TEST(EmissionLights, refuseWhatCannotBe) {
    const auto volume = volumeOf(glm::ivec3(20), glm::dvec3(1), ballOf(8));
    EXPECT_EQ(errorOf([&] { emissionLights(*volume, opticsOf({fireOf(volume)}), 0); }),
              "usage: `emissionLights`: got 0; expected 1 or more");
    const auto large = volumeOf(glm::ivec3(20), glm::dvec3(1e5), ballOf(8e5));
    Optics bright = opticsOf({fireOf(large, kOrange, 1e6)});
    EXPECT_EQ(errorOf([&] { emissionLights(*large, bright, 1); }).substr(0, 37),
              "input: emission: got a light of stren");
    // As bright as colour and strength allow together.
    const auto wide = volumeOf(glm::ivec3(20), glm::dvec3(100), ballOf(800));
    bright.parts = {fireOf(wide, kOrange, 10)};
    const std::vector<Light> lights = emissionLights(*wide, bright, 1);
    EXPECT_EQ(lights[0].strength, kMostLight);
    EXPECT_GT(lights[0].color.r, 1);
    expectNear(intensityOf(lights), intensityOfBall(800) * 10.0 / 3.0, 0.02);
}

}  // namespace
}  // namespace deltasplat
