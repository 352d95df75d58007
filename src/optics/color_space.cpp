// SPDX-License-Identifier: Apache-2.0
#include "optics/color_space.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/portable_math.h"
#include "image/srgb.h"

namespace deltasplat {

namespace {

// Columns: X, Y and Z of red, green and blue in shares of white's. Rows sum to exactly 1.
const glm::dmat3 kShareOfWhite = [] {
    glm::dmat3 shares(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505);
    for (int row = 0; row < 3; ++row) {
        const double white = shares[0][row] + shares[1][row] + shares[2][row];
        for (int color = 0; color < 3; ++color) shares[color][row] /= white;
    }
    return shares;
}();
const glm::dmat3 kFromShareOfWhite = glm::inverse(kShareOfWhite);

// Darker shares are on a straight line.
constexpr double kBend = 6.0 / 29;

double lightness(double share) {
    if (share > kBend * kBend * kBend) return portable::pow(share, 1.0 / 3);
    return share / (3 * kBend * kBend) + 4.0 / 29;
}

double shareOf(double lightness) {
    if (lightness > kBend) return lightness * lightness * lightness;
    return 3 * kBend * kBend * (lightness - 4.0 / 29);
}

}  // namespace

glm::dvec3 linearFromShareOfWhite(const glm::dvec3& share) {
    return kFromShareOfWhite * share;
}

glm::dvec3 labFromLinear(const glm::dvec3& rgb) {
    // Brighter colours would not convert back to finite numbers.
    constexpr double kBrightest = 1e200;
    const glm::dvec3 share = kShareOfWhite * glm::min(rgb, glm::dvec3(kBrightest));
    const double x = lightness(share.x);
    const double y = lightness(share.y);
    return {116 * y - 16, 500 * (x - y), 200 * (y - lightness(share.z))};
}

glm::dvec3 linearFromLab(const glm::dvec3& lab) {
    const double y = (lab.x + 16) / 116;
    return linearFromShareOfWhite({shareOf(y + lab.y / 500), shareOf(y), shareOf(y - lab.z / 200)});
}

glm::dvec3 mshFromLab(const glm::dvec3& lab) {
    const double chroma = portable::hypot(lab.y, lab.z);
    // The hue of grey is only rounding error, and no 8-bit colour is this dark but black.
    constexpr double kGrey = 1e-3;
    constexpr double kBlack = 0.1;
    const double magnitude = portable::hypot(lab.x, chroma);
    if (chroma <= kGrey * magnitude || magnitude < kBlack) return {magnitude, 0, 0};
    return {magnitude, portable::atan2(chroma, lab.x), portable::atan2(lab.z, lab.y)};
}

glm::dvec3 labFromMsh(const glm::dvec3& msh) {
    const double chroma = msh.x * portable::sin(msh.y);
    return {msh.x * portable::cos(msh.y), chroma * portable::cos(msh.z),
            chroma * portable::sin(msh.z)};
}

glm::dvec3 hsvFromRgb(const glm::dvec3& rgb) {
    const double most = std::max({rgb.r, rgb.g, rgb.b});
    const double spread = most - std::min({rgb.r, rgb.g, rgb.b});
    if (!(spread > 0)) return {0, 0, most};
    const double sixth = rgb.r == most   ? (rgb.g - rgb.b) / spread
                         : rgb.g == most ? 2 + (rgb.b - rgb.r) / spread
                                         : 4 + (rgb.r - rgb.g) / spread;
    return {(sixth < 0 ? sixth + 6 : sixth) / 6, spread / most, most};
}

glm::dvec3 rgbFromHsv(const glm::dvec3& hsv) {
    glm::dvec3 rgb;
    for (int c = 0; c < 3; ++c) {
        // Distance of the hue from the channel's hue, in sixths of a turn, both ways around.
        const double away = std::abs(hsv.x * 6 - 2 * c);
        const double nearest = std::min(away, 6 - away);
        rgb[c] = hsv.z * (1 - hsv.y * std::clamp(nearest - 1, 0.0, 1.0));
    }
    return rgb;
}

glm::dvec3 ColorFactor::largestOf(const ColorGrids& grids) {
    glm::dvec3 largest(1);
    for (int c = 0; c < 3; ++c)
        largest[c] = std::clamp(grids[std::size_t(c)]->valueMax(), 1.0, kBrightestColor);
    return largest;
}

std::uint32_t ColorFactor::packed(const glm::dvec3& share) {
    const glm::dvec3 root = glm::sqrt(glm::clamp(share, 0.0, 1.0));
    const auto bits = [](double part, int most) { return std::uint32_t(part * most + 0.5); };
    return bits(root.x, 2047) | bits(root.y, 2047) << 11 | bits(root.z, 1023) << 22;
}

glm::vec3 ColorFactor::unpacked(std::uint32_t bits) {
    const glm::vec3 root(float(bits & 2047) / 2047, float(bits >> 11 & 2047) / 2047,
                         float(bits >> 22) / 1023);
    return root * root;
}

WordFactors factorsOf(const OwnLook* looks) {
    WordFactors factors;
    for (std::size_t n = 0; n < 64; ++n) {
        const glm::vec3 factor = ColorFactor::unpacked(factorBits(looks[n]));
        for (int c = 0; c < 3; ++c) factors[std::size_t(c)][n] = factor[c];
    }
    return factors;
}

// Based on: M. Krystek, An Algorithm to Calculate Correlated Colour Temperature, 1985 (the locus of
// black bodies as quotients of polynomials, within 1e-4 in u and v).
namespace {

constexpr double kLowest = 1000;
constexpr double kHighest = 15000;

// Eyes see no glow below Draper's point, so the glow fades out from there on.
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
    constexpr double kStefanBoltzmann = 5.670374e-8;  // watts per square metre and kelvin^4
    const double share =
        std::clamp((kelvin - kDarkKelvin) / (kDraperPoint - kDarkKelvin), 0.0, 1.0);
    const double square = kelvin * kelvin * share;
    const double radiance = 1e-6 * kStefanBoltzmann / std::numbers::pi * square * square;
    return radiance * blackbodyColor(kelvin);
}

}  // namespace deltasplat
