// SPDX-License-Identifier: Apache-2.0
// Based on: M. Krystek, An Algorithm to Calculate Correlated Colour Temperature, 1985 (the locus of
// black bodies as quotients of polynomials, within 1e-4 of it in u and v).
#include "optics/blackbody.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "image/srgb.h"

namespace deltasplat {
namespace {

constexpr double kLowest = 1000;
constexpr double kHighest = 15000;

// Below Draper's point nothing is seen to glow, however it radiates; it fades out from there on.
constexpr double kDraperPoint = 798;

glm::dvec3 linearFromXyz(const glm::dvec3& xyz) {
    return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
            -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
            0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

}  // namespace

glm::dvec2 blackbodyChromaticity(double kelvin) {
    const double t = std::clamp(kelvin, kLowest, kHighest);
    const double u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
                     (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    const double v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
                     (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
    const double sum = 2 * u - 8 * v + 4;
    return {3 * u / sum, 2 * v / sum};
}

glm::dvec3 blackbodyColor(double kelvin) {
    const glm::dvec2 xy = blackbodyChromaticity(kelvin);
    const glm::dvec3 xyz(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
    const glm::dvec3 color = glm::max(linearFromXyz(xyz), glm::dvec3(0));
    return color / glm::dot(color, kLuminance);
}

glm::dvec3 blackbodyGlow(double kelvin) {
    if (!(kelvin > 0)) return glm::dvec3(0);
    constexpr double kStefanBoltzmann = 5.670374e-8;  // watts a square metre and kelvin^4
    const double share =
        std::clamp((kelvin - kDarkKelvin) / (kDraperPoint - kDarkKelvin), 0.0, 1.0);
    const double square = kelvin * kelvin * share;
    const double radiance = 1e-6 * kStefanBoltzmann / std::numbers::pi * square * square;
    return radiance * blackbodyColor(kelvin);
}

}  // namespace deltasplat
