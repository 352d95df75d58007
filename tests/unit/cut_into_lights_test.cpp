// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "deltasplat/error.h"
#include "deltasplat/optics/environment.h"
#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "unit/latlong_helpers.h"

namespace deltasplat {
namespace {

using test::errorOf;

constexpr double kPi = std::numbers::pi;

Environment uniform(int height, float value) {
    Environment environment;
    environment.sizePixels = {2 * height, height};
    environment.rgb.assign(3 * 2 * std::size_t(height) * std::size_t(height), value);
    return environment;
}

void setPixel(Environment& environment, int x, int y, const glm::vec3& rgb) {
    float* pixel = &environment.rgb[3 * std::size_t(y * environment.sizePixels.x + x)];
    for (int c = 0; c < 3; ++c) pixel[c] = rgb[c];
}

// From 1 to 1000 times as bright.
Environment randomEnvironment(int height, unsigned seed) {
    std::mt19937 random(seed);
    Environment environment = uniform(height, 0);
    for (float& value : environment.rgb) {
        value = std::pow(1000.0f, float(random() >> 8) / 16777216.0f);
    }
    return environment;
}

// A glow about a way, over a gradient from top to bottom.
Environment smoothSky(int height) {
    Environment environment = uniform(height, 0);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.3, 0.6, -0.5));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < 2 * height; ++x) {
            const glm::dvec3 way = test::pixelWay(environment.sizePixels, x, y);
            const double glow = 5 * std::exp(4 * (glm::dot(way, sun) - 1));
            setPixel(environment, x, y,
                     glm::vec3(glow + 1 + 0.3 * way.y, glow + 1, glow + 1.2 - 0.3 * way.y));
        }
    }
    return environment;
}

glm::dvec3 sumOf(const std::vector<Light>& lights) {
    glm::dvec3 sum(0);
    for (const Light& light : lights) sum += light.strength * light.color;
    return sum;
}

void expectClose(const glm::dvec3& a, const glm::dvec3& b, double share) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], share * std::abs(b[c])) << "channel " << c;
}

TEST(CutIntoLights, UniformSkyAddsUpToFour) {
    for (const int count : {1, 2, 3, 32, 33, 1000}) {
        const std::vector<Light> lights = cutIntoLights(uniform(64, 1), count);
        EXPECT_EQ(lights.size(), std::size_t(count));
        expectClose(sumOf(lights), glm::dvec3(4), 1e-13);
        glm::dvec3 ways(0);
        for (const Light& light : lights) {
            EXPECT_EQ(light.frame, LightFrame::kWorld);
            EXPECT_NEAR(glm::length(light.direction), 1, 1e-12);
            EXPECT_EQ(light.color, glm::dvec3(1));
            ways += light.strength * light.direction;
        }
        if (count >= 32) {
            EXPECT_LT(glm::length(ways), 0.02 * 4) << count;
        }
    }
}

TEST(CutIntoLights, WhatComesFromEverywhereComesFromAbove) {
    const std::vector<Light> lights = cutIntoLights(uniform(16, 1), 1);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0].direction, glm::dvec3(0, -1, 0));
}

TEST(CutIntoLights, OneBrightPixelIsOneLight) {
    const glm::ivec2 size(64, 32);
    for (const glm::ivec2 pixel :
         {glm::ivec2(40, 9), glm::ivec2(0, 16), glm::ivec2(63, 31), glm::ivec2(5, 0)}) {
        Environment environment = uniform(size.y, 0);
        setPixel(environment, pixel.x, pixel.y, {200, 100, 50});
        const std::vector<Light> lights = cutIntoLights(environment, 32);
        ASSERT_EQ(lights.size(), 1u);
        expectClose(sumOf(lights), test::solidAngle(size, pixel.y) / kPi * glm::dvec3(200, 100, 50),
                    1e-12);
        const glm::dvec3 way = test::pixelWay(size, pixel.x, pixel.y);
        EXPECT_LT(glm::distance(lights[0].direction, -way), 1e-12);
    }
}

// Such a picture is cut into squares of pixels.
TEST(CutIntoLights, OneBrightPixelOfMillions) {
    const glm::ivec2 size(2050, 1025);
    Environment environment = uniform(size.y, 1e-4f);
    setPixel(environment, 2049, 400, glm::vec3(5e5));
    const std::vector<Light> lights = cutIntoLights(environment, 32);
    EXPECT_EQ(lights.size(), 32u);
    expectClose(sumOf(lights), test::integrate(environment, [](auto) { return 1; }) / kPi, 1e-10);
    EXPECT_NEAR(lights[0].strength, 5e5 * test::solidAngle(size, 400) / kPi, 1e-3);
    const double halfPixel = kPi / size.x;
    EXPECT_LT(glm::distance(lights[0].direction, -test::pixelWay(size, 2049, 400)), halfPixel);
}

TEST(CutIntoLights, DirectionsAreThoseOfPanoramas) {
    struct Case {
        glm::ivec2 pixel;
        glm::dvec3 travels;
    };
    const double halfPixel = kPi / 200;
    for (const Case& c :
         {Case{{100, 50}, {0, 0, 1}}, Case{{150, 50}, {-1, 0, 0}}, Case{{0, 50}, {0, 0, -1}},
          Case{{50, 50}, {1, 0, 0}}, Case{{7, 0}, {0, -1, 0}}, Case{{7, 99}, {0, 1, 0}}}) {
        Environment environment = uniform(100, 0);
        setPixel(environment, c.pixel.x, c.pixel.y, glm::vec3(1));
        const Light light = cutIntoLights(environment, 4).at(0);
        EXPECT_LT(glm::distance(light.direction, c.travels), 1.5 * halfPixel) << c.pixel.x;
    }
}

TEST(CutIntoLights, NoLightIsLost) {
    const Environment environment = randomEnvironment(16, 5);
    const glm::dvec3 whole = test::integrate(environment, [](auto) { return 1; }) / kPi;
    for (const int count : {1, 2, 3, 32, 500, 512, 1000}) {
        const std::vector<Light> lights = cutIntoLights(environment, count);
        EXPECT_EQ(lights.size(), std::size_t(std::min(count, 512)));
        expectClose(sumOf(lights), whole, 1e-12);
        for (const Light& light : lights) {
            EXPECT_EQ(std::max({light.color.r, light.color.g, light.color.b}), 1);
        }
    }
}

// As many lights as pixels are the pixels.
TEST(CutIntoLights, EveryPixelCanBeALight) {
    const Environment environment = randomEnvironment(4, 9);
    const std::vector<Light> lights = cutIntoLights(environment, 32);
    ASSERT_EQ(lights.size(), 32u);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            const glm::dvec3 way = test::pixelWay({8, 4}, x, y);
            const auto same = [&](const Light& light) {
                return glm::distance(light.direction, -way) < 1e-12;
            };
            const auto light = std::find_if(lights.begin(), lights.end(), same);
            ASSERT_NE(light, lights.end());
            expectClose(light->strength * light->color,
                        test::solidAngle({8, 4}, y) / kPi * test::radiance(environment, x, y),
                        1e-12);
        }
    }
}

// A lamp on the seam is two lights of its two halves; one on a pole is one.
TEST(CutIntoLights, SeamAndPoles) {
    Environment seam = uniform(32, 0);
    setPixel(seam, 0, 12, glm::vec3(10));
    setPixel(seam, 63, 12, glm::vec3(10));
    const std::vector<Light> two = cutIntoLights(seam, 8);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_LT(glm::distance(two[0].direction, two[1].direction), 2 * kPi / 64);

    Environment pole = uniform(32, 0);
    for (int x = 0; x < 64; ++x) setPixel(pole, x, 0, glm::vec3(10));
    const std::vector<Light> one = cutIntoLights(pole, 1);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_LT(glm::distance(one[0].direction, glm::dvec3(0, -1, 0)), 1e-12);
}

glm::dvec3 irradianceOf(const std::vector<Light>& lights, const glm::dvec3& normal) {
    glm::dvec3 sum(0);
    for (const Light& light : lights) {
        const double share = std::max(0.0, -glm::dot(light.direction, normal));
        sum += kPi * share * light.strength * light.color;
    }
    return sum;
}

TEST(CutIntoLights, LightOnPlanesIsThatOfTheSky) {
    const Environment sky = smoothSky(64);
    const glm::dvec3 fromSky = test::irradiance(sky, {0, 1, 0});
    expectClose(irradianceOf(cutIntoLights(sky, 32), {0, 1, 0}), fromSky, 0.04);
    // What faces away from the glow is lit by few of the lights.
    for (const glm::dvec3 normal : {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1),
                                    glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0, -0.8)}) {
        const glm::dvec3 expected = test::irradiance(sky, normal);
        expectClose(irradianceOf(cutIntoLights(sky, 32), normal), expected, 0.07);
        expectClose(irradianceOf(cutIntoLights(sky, 1000), normal), expected, 0.003);
    }
}

TEST(CutIntoLights, TurnsWithTheEnvironment) {
    Environment environment = smoothSky(16);
    const std::vector<Light> before = cutIntoLights(environment, 20);
    environment.worldFromEnvironment =
        glm::dmat3(glm::rotate(glm::dmat4(1), 1.1, glm::normalize(glm::dvec3(1, 2, -3))));
    const std::vector<Light> turned = cutIntoLights(environment, 20);
    ASSERT_EQ(turned.size(), before.size());
    for (std::size_t i = 0; i < turned.size(); ++i) {
        EXPECT_EQ(turned[i].strength, before[i].strength);
        EXPECT_EQ(turned[i].color, before[i].color);
        EXPECT_EQ(turned[i].direction, environment.worldFromEnvironment * before[i].direction);
    }
}

TEST(CutIntoLights, BrightestFirstAndAlwaysTheSame) {
    const Environment environment = randomEnvironment(64, 2);
    const auto lightsOn = [&](int threads) {
        const ThreadLimit limit(threads);
        return cutIntoLights(environment, 50);
    };
    const std::vector<Light> once = lightsOn(1);
    const std::vector<Light> again = lightsOn(4);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_EQ(once[i].direction, again[i].direction);
        EXPECT_EQ(once[i].color, again[i].color);
        EXPECT_EQ(once[i].strength, again[i].strength);
        EXPECT_LE(once[i].strength, once[i > 0 ? i - 1 : 0].strength);
    }
}

TEST(CutIntoLights, BlackGivesNone) {
    EXPECT_TRUE(cutIntoLights(uniform(8, 0), 32).empty());
}

TEST(CutIntoLights, Refusals) {
    Environment environment = uniform(4, 1);
    EXPECT_EQ(errorOf([&] { cutIntoLights(environment, 0); }),
              "usage: `count`: got 0 lights; expected 1 or more");
    environment.rgb.pop_back();
    EXPECT_EQ(errorOf([&] { cutIntoLights(environment, 1); }),
              "usage: `rgb`: got 95 values; expected three for each of 8x4 pixels");
    environment.sizePixels = {4, 4};
    EXPECT_EQ(errorOf([&] { cutIntoLights(environment, 1); }),
              "usage: `sizePixels`: got 4x4; expected twice as wide as high");
    EXPECT_EQ(errorOf([] { cutIntoLights(Environment{}, 1); }),
              "usage: `sizePixels`: got 0x0; expected twice as wide as high");
    for (const glm::dmat3& matrix :
         {glm::dmat3(2), glm::dmat3(-1), glm::dmat3(1, 0.1, 0, 0, 1, 0, 0, 0, 1),
          glm::dmat3(std::numeric_limits<double>::quiet_NaN())}) {
        Environment turned = uniform(4, 1);
        turned.worldFromEnvironment = matrix;
        EXPECT_EQ(errorOf([&] { cutIntoLights(turned, 1); }),
                  "usage: `worldFromEnvironment`: got no rotation; expected a rotation");
    }
    EXPECT_EQ(errorOf([] { cutIntoLights(uniform(4, 2.5e6f), 4); }).substr(0, 51),
              "input: environment: got a light of strength 2500000");
    EXPECT_EQ(errorOf([] { cutIntoLights(uniform(4, 9e5f), 4); }), "no error");
}

}  // namespace
}  // namespace deltasplat
