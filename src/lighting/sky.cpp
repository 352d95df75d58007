// SPDX-License-Identifier: Apache-2.0
// Based on: A. J. Preetham, Peter Shirley and Brian Smits, "A Practical Analytic Model for
// Daylight", 1999: appendix 2 (coefficients of Perez' function, the zenith) and appendix 1,
// "Transmittance expressions for atmospheric constituents", after Muhammad Iqbal, "An Introduction
// to Solar Radiation", 1983 (Rayleigh, Angstrom's aerosol, Leckner's ozone, Kasten's air mass),
// with table 2 (the sun's spectrum, ozone), without water vapour and mixed gases, which absorb from
// 690 nm on; Stanislav Darula, Richard Kittler and Christian Gueymard, "Reference luminous solar
// constant and solar luminance for illuminance calculations", 2005 (133 klx); and Chris Wyman,
// Peter-Pike Sloan and Peter Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions", 2013 (the observer, multi-lobe).
#include "lighting/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/environment.h"
#include "deltasplat/optics/sky.h"
#include "modules/image_module.h"
#include "optics/color_space.h"
#include "view/picture_rays.h"

namespace deltasplat {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kKiloluxOfSun = 133;
constexpr int kHeight = 256;

struct Place {
    glm::dvec3 up;          // of length 1
    glm::dvec3 horizontal;  // the sun's side of the horizon, of length 1
    double height;          // sine of the sun's elevation
    double zenithAngle;     // of the sun, 0..pi
};

void requireRange(const std::string& option, double number, double least, double most) {
    if (number >= least && number <= most) return;
    refuseUsage(option, numberText(number), numberText(least) + ".." + numberText(most));
}

glm::dvec3 unitOf(const std::string& option, const glm::dvec3& way) {
    const double size = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
    const bool finite = std::isfinite(way.x) && std::isfinite(way.y) && std::isfinite(way.z);
    if (!finite || !(size > 0)) refuseUsage(option, numberText(way), "a direction");
    return unitVectorOf(way);
}

Place placeOf(const Sky& sky) {
    requireRange("`turbidity`", sky.turbidity, kLeastTurbidity, kMostTurbidity);
    requireRange("`strength`", sky.strength, 0, kMostLight);
    for (int c = 0; c < 3; ++c) requireRange("`groundAlbedo`", sky.groundAlbedo[c], 0, 1);
    const glm::dvec3 up = unitOf("`up`", sky.up);
    const glm::dvec3 sun = unitOf("`towardsSun`", sky.towardsSun);
    const double height = glm::dot(sun, up);
    glm::dvec3 level = sun - height * up;
    const double distance = glm::length(level);
    // If the sun is at or near the zenith, any side is the sun's.
    if (distance < 1e-6)
        level = glm::cross(up, std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
    return {up, glm::normalize(level), height, portable::atan2(distance, height)};
}

// Rounding must not make a sun on the horizon set.
bool isUp(const Place& place) {
    return place.height > -1e-9;
}

// A quantity over the sky, relative to the zenith.
struct Perez {
    double a, b, c, d, e;

    double at(double cosZenithAngle, double sunAngle) const {
        const double cosine = portable::cos(sunAngle);
        return (1 + a * portable::exp(b / cosZenithAngle)) *
               (1 + c * portable::exp(d * sunAngle) + e * cosine * cosine);
    }
};

// Models of the chromaticities x and y and the luminance Y.
struct SkyModel {
    std::array<Perez, 3> perez;
    std::array<double, 3> zenith;  // divided by perez at the zenith
};

// Columns: coefficients of the cube, square, first and zeroth power of the sun's zenith angle.
// Rows: of the square, first and zeroth power of turbidity.
double zenithChromaticity(const double (&rows)[3][4], double angle, double turbidity) {
    double value = 0;
    for (const auto& row : rows) {
        value = value * turbidity + (((row[0] * angle + row[1]) * angle + row[2]) * angle + row[3]);
    }
    return value;
}

// In kcd/m^2.
double zenithLuminance(double angle, double turbidity) {
    const double chi = (4.0 / 9 - turbidity / 120) * (kPi - 2 * angle);
    return (4.0453 * turbidity - 4.9710) * (portable::sin(chi) / portable::cos(chi)) -
           0.2155 * turbidity + 2.4192;
}

SkyModel modelOf(double angle, double turbidity) {
    const double t = turbidity;
    SkyModel model{{{{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
                      -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
                     {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
                      -0.0441 * t - 1.6537, -0.0109 * t + 0.0529},
                     {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                      0.1206 * t - 2.5771, -0.0670 * t + 0.3703}}},
                   {}};
    constexpr double kZenithX[3][4] = {{0.00166, -0.00375, 0.00209, 0},
                                       {-0.02903, 0.06377, -0.03202, 0.00394},
                                       {0.11693, -0.21196, 0.06052, 0.25886}};
    constexpr double kZenithY[3][4] = {{0.00275, -0.00610, 0.00317, 0},
                                       {-0.04214, 0.08970, -0.04153, 0.00516},
                                       {0.15346, -0.26756, 0.06670, 0.26688}};
    model.zenith = {zenithChromaticity(kZenithX, angle, t), zenithChromaticity(kZenithY, angle, t),
                    zenithLuminance(angle, t)};
    for (std::size_t i = 0; i < 3; ++i) model.zenith[i] /= model.perez[i].at(1, angle);
    return model;
}

// Relative to sunlight above the atmosphere, whose irradiance is pi.
glm::dvec3 radianceOf(const SkyModel& model, double cosZenithAngle, double sunAngle) {
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < 3; ++i) {
        value[i] = model.zenith[i] * model.perez[i].at(cosZenithAngle, sunAngle);
    }
    const auto [x, y, luminance] = value;
    const double relative = luminance * (kPi / kKiloluxOfSun);
    return colorUnderSun(relative / y * glm::dvec3(x, y, 1 - x - y));
}

void paintSky(const Place& place, const Sky& sky, Environment& environment) {
    const SkyModel model = modelOf(place.zenithAngle, sky.turbidity);
    Camera all;
    all.projection = Projection::kLatlong;
    all.sizePixels = environment.sizePixels;
    const PictureRays rays(all, glm::dmat3(1));
    const glm::dvec3 sun(0, portable::cos(place.zenithAngle), -portable::sin(place.zenithAngle));
    const int width = environment.sizePixels.x;
    parallelFor(std::size_t(environment.sizePixels.y / 2), [&](std::size_t y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 ray = rays.at(x, int(y));
            const double angle =
                portable::atan2(glm::length(glm::cross(ray, sun)), glm::dot(ray, sun));
            const glm::dvec3 color = sky.strength * radianceOf(model, ray.y, angle);
            float* pixel = &environment.rgb[3 * (y * std::size_t(width) + std::size_t(x))];
            for (int c = 0; c < 3; ++c) pixel[c] = float(color[c]);
        }
    });
}

// Irradiance of the ground from the upper half, divided by pi.
glm::dvec3 lightFromAbove(const Environment& environment) {
    const glm::ivec2 size = environment.sizePixels;
    glm::dvec3 sum(0);
    for (int y = 0; y < size.y / 2; ++y) {
        glm::dvec3 row(0);
        for (int x = 0; x < size.x; ++x) {
            const float* rgb = &environment.rgb[3 * (std::size_t(y) * std::size_t(size.x) + x)];
            row += glm::dvec3(rgb[0], rgb[1], rgb[2]);
        }
        // The integral of sin cos over latitude is sin^2 / 2; the differences of sin^2 add up to 1.
        const double below = portable::sin(kPi * (0.5 - double(y + 1) / size.y));
        const double above = portable::sin(kPi * (0.5 - double(y) / size.y));
        sum += (above * above - below * below) / size.x * row;
    }
    return sum;
}

void paintGround(const glm::dvec3& color, Environment& environment) {
    const std::size_t half = environment.rgb.size() / 2;
    for (std::size_t i = half; i < environment.rgb.size(); ++i) {
        environment.rgb[i] = float(color[glm::length_t(i % 3)]);
    }
}

}  // namespace

Environment skyEnvironment(const Sky& sky) {
    const DefaultFloats floats;
    const Place place = placeOf(sky);
    if (!isUp(place)) {
        refuseUsage("`towardsSun`", numberText(sky.towardsSun) + ", below the horizon",
                    "a sun above it: of twilight nothing is known");
    }
    Environment environment;
    environment.sizePixels = {2 * kHeight, kHeight};
    environment.rgb.resize(3 * std::size_t{2 * kHeight} * kHeight);
    environment.worldFromEnvironment =
        glm::dmat3(glm::cross(place.horizontal, place.up), place.up, -place.horizontal);
    paintSky(place, sky, environment);
    const Light sun = sunLight(sky);
    const glm::dvec3 onGround =
        lightFromAbove(environment) + std::max(0.0, place.height) * sun.strength * sun.color;
    paintGround(sky.groundAlbedo * onGround, environment);
    return environment;
}

Light sunLight(const Sky& sky) {
    const DefaultFloats floats;
    const Place place = placeOf(sky);
    Light light{LightFrame::kWorld, -unitOf("`towardsSun`", sky.towardsSun), glm::dvec3(0),
                sky.strength};
    if (isUp(place)) light.color = sunColor(place.zenithAngle, sky.turbidity);
    return light;
}

namespace {

struct Wavelength {
    double sun;    // radiance, in any unit
    double ozone;  // absorption per centimetre
};

// From 380 to 750 nm.
constexpr double kFirstNanometres = 380;
constexpr double kStepNanometres = 10;
constexpr std::array<Wavelength, 38> kSpectrum{
    {{165.5, 0},     {162.3, 0},     {211.2, 0},     {258.8, 0},     {258.2, 0},     {242.3, 0},
     {267.6, 0},     {296.6, 0.003}, {305.4, 0.006}, {300.6, 0.009}, {306.6, 0.014}, {288.3, 0.021},
     {287.1, 0.03},  {278.2, 0.04},  {271.0, 0.048}, {272.3, 0.063}, {263.6, 0.075}, {255.0, 0.085},
     {250.6, 0.103}, {253.1, 0.12},  {253.5, 0.12},  {251.3, 0.115}, {246.3, 0.125}, {241.7, 0.12},
     {236.8, 0.105}, {232.1, 0.09},  {228.2, 0.079}, {223.4, 0.067}, {219.7, 0.057}, {215.3, 0.048},
     {211.0, 0.036}, {207.3, 0.028}, {202.4, 0.023}, {198.7, 0.018}, {194.3, 0.014}, {190.7, 0.011},
     {186.3, 0.01},  {182.6, 0.009}}};

// A bell curve with different widths on its two sides.
double lobe(double nanometres, double middle, double before, double behind) {
    const double away = (nanometres - middle) / (nanometres < middle ? before : behind);
    return portable::exp(-0.5 * away * away);
}

glm::dvec3 observerAt(double nanometres) {
    return {
        1.056 * lobe(nanometres, 599.8, 37.9, 31.0) + 0.362 * lobe(nanometres, 442.0, 16.0, 26.7) -
            0.065 * lobe(nanometres, 501.1, 20.4, 26.2),
        0.821 * lobe(nanometres, 568.8, 46.9, 40.5) + 0.286 * lobe(nanometres, 530.9, 16.3, 31.1),
        1.217 * lobe(nanometres, 437.0, 11.8, 36.0) + 0.681 * lobe(nanometres, 459.0, 26.0, 13.8)};
}

// Relative to the air straight above.
double airMass(double zenithAngle) {
    const double degrees = zenithAngle * (180 / std::numbers::pi);
    return 1 / (portable::cos(zenithAngle) + 0.15 * portable::pow(93.885 - degrees, -1.253));
}

double depthOfAir(double micrometres, const Wavelength& wavelength, double turbidity) {
    constexpr double kOzoneCentimetres = 0.35;
    const double aerosol = 0.04608 * turbidity - 0.04586;
    return 0.008735 * portable::pow(micrometres, -4.08) +
           aerosol * portable::pow(micrometres, -1.3) + kOzoneCentimetres * wavelength.ozone;
}

// XYZ of the sunlight that comes through.
glm::dvec3 sunXyz(double mass, double turbidity) {
    glm::dvec3 xyz(0);
    for (std::size_t i = 0; i < kSpectrum.size(); ++i) {
        const double nanometres = kFirstNanometres + kStepNanometres * double(i);
        const double depth = depthOfAir(nanometres / 1000, kSpectrum[i], turbidity);
        xyz += kSpectrum[i].sun * portable::exp(-mass * depth) * observerAt(nanometres);
    }
    return xyz;
}

const glm::dvec3& aboveAir() {
    static const glm::dvec3 xyz = sunXyz(0, 0);
    return xyz;
}

}  // namespace

glm::dvec3 colorUnderSun(const glm::dvec3& xyz) {
    const glm::dvec3 share = xyz / (aboveAir() / aboveAir().y);
    return glm::max(linearFromShareOfWhite(share), glm::dvec3(0));
}

glm::dvec3 sunColor(double zenithAngle, double turbidity) {
    return colorUnderSun(sunXyz(airMass(zenithAngle), turbidity) / aboveAir().y);
}

// Implemented by the image module.
Environment readEnvironment(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readEnvironment(file, listener);
}

}  // namespace deltasplat
