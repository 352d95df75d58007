// SPDX-License-Identifier: Apache-2.0
// Based on: G. Box, M. Muller, "A Note on the Generation of Random Normal Deviates", 1958.
// Based on: K. Perlin, "Improving Noise", 2002 (fade curve, twelve gradients); F. K. Musgrave in
// "Texturing and Modeling: A Procedural Approach", 2003, chapter 16 (sum of octaves). Deviation: a
// hash of lattice coordinates and seed replaces the table, so the noise never repeats.
#include "synth/noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/portable_math.h"

namespace deltasplat {

namespace {

double gaussianAt(std::uint64_t seed, const glm::dvec3& p) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 is 0
    const std::uint64_t hash = hash3(seed, bits(p.x), bits(p.y), bits(p.z));
    const double radius = std::sqrt(-2 * portable::log(1 - unitFromBits(hash)));
    return radius * portable::cos(2 * std::numbers::pi * unitFromBits(mixBits(hash + 1)));
}

}  // namespace

ValueAt withNoise(ValueAt valueAt, std::uint64_t seed, double noise) {
    if (noise == 0) return valueAt;
    return [valueAt = std::move(valueAt), seed, noise](const glm::dvec3& p) {
        return std::clamp(valueAt(p) + noise * gaussianAt(seed, p), 0.0, 1.0);
    };
}

namespace {

constexpr double kNextStrength = 0.45;  // of each octave, relative to the previous one

double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

double lerp(double t, double a, double b) {
    return a + t * (b - a);
}

// Returns the dot product of an offset with one of twelve gradients (1,1,0), (-1,1,0), ...
double gradientAt(std::uint64_t seed, const glm::ivec3& cell, const glm::dvec3& offset) {
    const auto part = [](int i) { return std::uint64_t(std::int64_t(i)); };
    const std::uint64_t hash = hash3(seed, part(cell.x), part(cell.y), part(cell.z)) >> 32;
    const int missing = int(hash % 3);
    const double u = missing == 0 ? offset.y : offset.x;
    const double v = missing == 2 ? offset.y : offset.z;
    return ((hash >> 8 & 1) ? -u : u) + ((hash >> 9 & 1) ? -v : v);
}

}  // namespace

double noiseAt(std::uint64_t seed, const glm::dvec3& p) {
    const glm::ivec3 cell(int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z)));
    const glm::dvec3 t = p - glm::dvec3(cell);
    std::array<double, 8> corners;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        corners[std::size_t(i)] = gradientAt(seed, cell + corner, t - glm::dvec3(corner));
    }
    const double u = fade(t.x), v = fade(t.y), w = fade(t.z);
    const double low = lerp(v, lerp(u, corners[0], corners[1]), lerp(u, corners[2], corners[3]));
    const double high = lerp(v, lerp(u, corners[4], corners[5]), lerp(u, corners[6], corners[7]));
    return lerp(w, low, high);
}

double fractalAt(std::uint64_t seed, glm::dvec3 p, int octaves) {
    double sum = 0;
    double strength = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength * noiseAt(mixBits(seed) + std::uint64_t(octave), p);
        p *= 2.0;
        strength *= kNextStrength;
    }
    return sum;
}

glm::dvec3 turbulenceAt(std::uint64_t seed, const glm::dvec3& p, int octaves) {
    const auto part = [&](std::uint64_t axis) {
        return fractalAt(hash3(seed, axis, 0, 0), p, octaves);
    };
    return {part(0), part(1), part(2)};
}

double billowAt(std::uint64_t seed, glm::dvec3 p) {
    constexpr int kOctaves = 5;
    double sum = 0;
    double strength = 1;
    for (int octave = 0; octave < kOctaves; ++octave) {
        sum += strength * std::abs(noiseAt(mixBits(seed) + std::uint64_t(octave), p));
        p *= 2.0;
        strength *= kNextStrength;
    }
    return std::min(sum, 1.0);
}

}  // namespace deltasplat
