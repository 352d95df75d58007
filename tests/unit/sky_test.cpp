// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/matrix.hpp>
#include <limits>

#include "deltasplat/error.h"
#include "deltasplat/optics/sky.h"
#include "support/error_of.h"
#include "synth/noise.h"
#include "unit/latlong_helpers.h"

namespace deltasplat {
namespace {

using test::errorOf;

constexpr double kPi = std::numbers::pi;
constexpr double kKilolux = 133 / kPi;  // of a radiance of 1: kcd/m^2

Sky skyAt(double elevationDegrees, double turbidity = 3) {
    Sky sky;
    const double elevation = elevationDegrees * kPi / 180;
    sky.towardsSun = {3 * std::cos(elevation), 3 * std::sin(elevation), 0};
    sky.turbidity = turbidity;
    return sky;
}

// Preetham's luminance of the sky in kcd/m^2, written down anew.
double luminanceOf(double t, double sunZenith, double zenith, double sunAngle) {
    const double chi = (4.0 / 9.0 - t / 120.0) * (kPi - 2.0 * sunZenith);
    const double inZenith = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    const auto perez = [t](double theta, double gamma) {
        return (1 + (0.1787 * t - 1.4630) * std::exp((-0.3554 * t + 0.4275) / std::cos(theta))) *
               (1 + (-0.0227 * t + 5.3251) * std::exp((0.1206 * t - 2.5771) * gamma) +
                (-0.0670 * t + 0.3703) * std::pow(std::cos(gamma), 2));
    };
    return inZenith * perez(zenith, sunAngle) / perez(0, sunZenith);
}

double aboveHorizon(const Environment& environment, const glm::dvec3& weights) {
    const auto level = [](const glm::dvec3& way) { return std::max(0.0, way.y); };
    return glm::dot(weights, test::integrate(environment, level));
}

TEST(Sky, LuminanceIsPreethams) {
    for (const double turbidity : {2.0, 3.5, 6.0, 10.0}) {
        for (const double elevation : {5.0, 30.0, 80.0}) {
            const Environment sky = skyEnvironment(skyAt(elevation, turbidity));
            const double sunZenith = (90 - elevation) * kPi / 180;
            const glm::dvec3 sun(0, std::cos(sunZenith), -std::sin(sunZenith));
            const glm::ivec2 size = sky.sizePixels;
            for (int y = 0; y < size.y / 2; y += 9) {
                for (int x = 0; x < size.x; x += 31) {
                    const glm::dvec3 way = test::pixelWay(size, x, y);
                    const double expected =
                        luminanceOf(turbidity, sunZenith, std::acos(way.y),
                                    std::acos(std::clamp(glm::dot(way, sun), -1.0, 1.0)));
                    EXPECT_NEAR(test::luminance(test::radiance(sky, x, y)) * kKilolux, expected,
                                1e-5 * expected);
                }
            }
        }
    }
}

TEST(Sky, ZenithIsPreethams) {
    for (const double elevation : {0.0, 10.0, 45.0}) {
        const Environment sky = skyEnvironment(skyAt(elevation));
        const double chi = (4.0 / 9 - 3.0 / 120) * (kPi - 2 * (90 - elevation) * kPi / 180);
        const double expected = (4.0453 * 3 - 4.9710) * std::tan(chi) - 0.2155 * 3 + 2.4192;
        double mean = 0;
        for (int x = 0; x < sky.sizePixels.x; ++x) {
            mean += test::luminance(test::radiance(sky, x, 0)) / sky.sizePixels.x;
        }
        EXPECT_NEAR(mean * kKilolux, expected, 0.001 * expected);
    }
}

TEST(Sky, IsSymmetricAboutTheSun) {
    const Environment sky = skyEnvironment(skyAt(25));
    const glm::ivec2 size = sky.sizePixels;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x / 2; ++x) {
            ASSERT_EQ(test::radiance(sky, x, y), test::radiance(sky, size.x - 1 - x, y));
        }
    }
}

TEST(Sky, LiesInTheWorldAsUpAndSunSay) {
    Sky tilted;
    tilted.up = {0, 0, 5};
    tilted.towardsSun = {1, 1, 1};
    const Environment sky = skyEnvironment(tilted);
    const glm::dmat3& turn = sky.worldFromEnvironment;
    EXPECT_NEAR(glm::determinant(turn), 1, 1e-12);
    EXPECT_LT(glm::distance(turn * glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)), 1e-12);
    const double third = std::sqrt(1 / 3.0);
    EXPECT_LT(glm::distance(turn * glm::dvec3(0, third, -std::sqrt(2) * third), glm::dvec3(third)),
              1e-12);
    EXPECT_LT(glm::distance(sunLight(tilted).direction, -glm::dvec3(third)), 1e-12);
    // It matters to nothing else.
    Sky upright;
    upright.towardsSun = {std::sqrt(2), 1, 0};
    const Environment same = skyEnvironment(upright);
    for (std::size_t i = 0; i < sky.rgb.size(); ++i) ASSERT_NEAR(sky.rgb[i], same.rgb[i], 1e-6);
}

TEST(Sky, IsLightOrNothingEverywhere) {
    for (const double turbidity : {2.0, 4.0, 10.0}) {
        for (double elevation = 0; elevation <= 90; elevation += 7.5) {
            for (const float value : skyEnvironment(skyAt(elevation, turbidity)).rgb) {
                ASSERT_TRUE(std::isfinite(value) && value >= 0) << elevation;
            }
        }
        for (double elevation = -90; elevation <= 90; elevation += 1) {
            const glm::dvec3 sun = sunLight(skyAt(elevation, turbidity)).color;
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(sun[c] >= 0 && sun[c] < 1) << elevation;
            EXPECT_EQ(sun == glm::dvec3(0), elevation < 0) << elevation;
        }
    }
}

TEST(Sky, SunsetIsRedderThanNoon) {
    double redder = 1;
    for (const double elevation : {90.0, 45.0, 20.0, 10.0, 5.0, 2.0}) {
        const glm::dvec3 sun = sunLight(skyAt(elevation)).color;
        EXPECT_GT(sun.r, sun.g);
        EXPECT_GT(sun.g, sun.b);
        EXPECT_GT(sun.r / sun.b, 1.1 * redder) << elevation;
        redder = sun.r / sun.b;
    }
    EXPECT_GT(redder, 100);
    const auto redOfHorizon = [](double elevation) {
        const Environment sky = skyEnvironment(skyAt(elevation));
        const glm::dvec3 color =
            test::radiance(sky, sky.sizePixels.x / 2, sky.sizePixels.y / 2 - 1);
        return color.r / color.b;
    };
    EXPECT_GT(redOfHorizon(3), 2 * redOfHorizon(60));
    // By day the sky is blue.
    const glm::dvec3 zenith = test::radiance(skyEnvironment(skyAt(45)), 0, 0);
    EXPECT_GT(zenith.b, 1.5 * zenith.g);
    EXPECT_GT(zenith.g, 1.2 * zenith.r);
}

// At 30 degrees light goes through twice the air, and what is left is squared.
TEST(Sky, TwiceTheAirTakesTwiceTheLight) {
    for (const double turbidity : {2.0, 4.0}) {
        const glm::dvec3 zenith = sunLight(skyAt(90, turbidity)).color;
        const glm::dvec3 low = sunLight(skyAt(30, turbidity)).color;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(std::log(low[c]) / std::log(zenith[c]), 2, 0.06) << c;
        }
        // Green is close to what happens at 550 nm.
        const double depth = 0.008735 * std::pow(0.55, -4.08) +
                             (0.04608 * turbidity - 0.04586) * std::pow(0.55, -1.3) + 0.35 * 0.085;
        EXPECT_NEAR(std::log(zenith.g), -depth, 0.1 * depth);
    }
}

// Of the sun's light most arrives by day, and no more than there is.
TEST(Sky, SkyAndSunKeepTheirRatio) {
    const glm::dvec3 weights(0.2126, 0.7152, 0.0722);
    for (const double elevation : {30.0, 60.0, 80.0}) {
        const double sunHeight = std::sin(elevation * kPi / 180);
        const double fromSky = aboveHorizon(skyEnvironment(skyAt(elevation)), weights);
        const double fromSun =
            kPi * sunHeight * glm::dot(weights, sunLight(skyAt(elevation)).color);
        EXPECT_GT(fromSky + fromSun, 0.85 * kPi * sunHeight);
        EXPECT_LT(fromSky + fromSun, kPi * sunHeight);
        EXPECT_GT(fromSun, 1.4 * fromSky);
    }
}

TEST(Sky, GroundSendsBackWhatFallsOnIt) {
    Sky sky = skyAt(40);
    sky.groundAlbedo = {0, 0.3, 1};
    const Environment environment = skyEnvironment(sky);
    const glm::dvec3 sun = kPi * std::sin(40 * kPi / 180) * sunLight(sky).color;
    const glm::dvec3 falls = test::irradiance(environment, {0, 1, 0}) + sun;
    const glm::ivec2 size = environment.sizePixels;
    for (const int y : {size.y / 2, size.y - 1}) {
        const glm::dvec3 ground = test::radiance(environment, 17, y);
        EXPECT_EQ(ground.r, 0);
        EXPECT_NEAR(ground.g, 0.3 * falls.g / kPi, 1e-3 * ground.g);
        EXPECT_NEAR(ground.b, falls.b / kPi, 1e-3 * ground.b);
    }
}

TEST(Sky, StrengthIsThatOfBoth) {
    Sky sky = skyAt(50);
    const Environment once = skyEnvironment(sky);
    EXPECT_EQ(sunLight(sky).strength, 1);
    sky.strength = 8;
    const Environment stronger = skyEnvironment(sky);
    EXPECT_EQ(sunLight(sky).strength, 8);
    for (std::size_t i = 0; i < once.rgb.size(); ++i) {
        ASSERT_NEAR(stronger.rgb[i], 8 * once.rgb[i], 1e-6 * stronger.rgb[i]);
    }
}

TEST(Sky, SunAtHorizonAndZenith) {
    EXPECT_EQ(errorOf([] { skyEnvironment(skyAt(0)); }), "no error");
    EXPECT_EQ(errorOf([] { skyEnvironment(skyAt(90)); }), "no error");
    Sky sky;
    for (const glm::dvec3 up : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
        sky.up = sky.towardsSun = up;
        const glm::dmat3 turn = skyEnvironment(sky).worldFromEnvironment;
        EXPECT_NEAR(glm::determinant(turn), 1, 1e-12);
        EXPECT_EQ(turn[1], up);
    }
}

// On every processor: a hash of the picture, and of what it is cut into.
TEST(Sky, HasTheSameBitsEverywhere) {
    std::uint64_t hash = 0;
    const auto add = [&](double value) {
        hash = mixBits(hash ^ std::bit_cast<std::uint64_t>(value)) + 1;
    };
    const auto addLight = [&](const Light& light) {
        for (int c = 0; c < 3; ++c) {
            add(light.direction[c]);
            add(light.color[c]);
        }
        add(light.strength);
    };
    for (const double turbidity : {2.5, 7.0}) {
        Sky sky;
        sky.towardsSun = {2, 1, -1};
        sky.turbidity = turbidity;
        const Environment environment = skyEnvironment(sky);
        for (const float value : environment.rgb) add(double(value));
        addLight(sunLight(sky));
        for (const Light& light : cutIntoLights(environment, 32)) addLight(light);
    }
    EXPECT_EQ(hash, 0x7d0ecda523f7e5au);
}

TEST(Sky, Refusals) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto with = [](auto change) {
        Sky sky;
        change(sky);
        const std::string error = errorOf([&] { skyEnvironment(sky); });
        EXPECT_EQ(errorOf([&] { sunLight(sky); }), error);
        return error;
    };
    EXPECT_EQ(with([](Sky& sky) { sky.turbidity = 1.9; }),
              "usage: `turbidity`: got 1.9; expected 2..10");
    EXPECT_EQ(with([](Sky& sky) { sky.turbidity = 11; }),
              "usage: `turbidity`: got 11; expected 2..10");
    EXPECT_EQ(with([=](Sky& sky) { sky.turbidity = nan; }),
              "usage: `turbidity`: got nan; expected 2..10");
    EXPECT_EQ(with([](Sky& sky) { sky.strength = -1; }),
              "usage: `strength`: got -1; expected 0..1e+06");
    EXPECT_EQ(with([](Sky& sky) { sky.groundAlbedo.b = 1.5; }),
              "usage: `groundAlbedo`: got 1.5; expected 0..1");
    EXPECT_EQ(with([](Sky& sky) {
                  sky.up = {0, 0, 0};
              }),
              "usage: `up`: got 0,0,0; expected a direction");
    EXPECT_EQ(with([=](Sky& sky) {
                  sky.towardsSun = {0, nan, 0};
              }),
              "usage: `towardsSun`: got 0,nan,0; expected a direction");
    EXPECT_EQ(errorOf([] {
                  Sky sky;
                  sky.towardsSun = {1, -0.25, 0};
                  skyEnvironment(sky);
              }),
              "usage: `towardsSun`: got 1,-0.25,0, below the horizon; expected a sun above it: of "
              "twilight nothing is known");
}

}  // namespace
}  // namespace deltasplat
