// SPDX-License-Identifier: Apache-2.0
// Based on: K. Perlin, "Improving Noise", 2002 (fade curve and twelve gradients); F. K. Musgrave in
// "Texturing and Modeling: A Procedural Approach", 2003, chapter 16 (octaves added up). Deviates in
// that a hash of lattice coordinates and seed replaces the table, so that the noise never repeats.
#include <algorithm>
#include <array>
#include <cmath>

#include "synth/hash.h"
#include "synth/volumes.h"

namespace deltasplat {
namespace {

double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

double lerp(double t, double a, double b) {
    return a + t * (b - a);
}

// The scalar product of one of twelve gradients (1,1,0), (-1,1,0), ... with an offset.
double gradientAt(std::uint64_t seed, const glm::ivec3& cell, const glm::dvec3& offset) {
    const auto part = [](int i) { return std::uint64_t(std::int64_t(i)); };
    const std::uint64_t hash = hash3(seed, part(cell.x), part(cell.y), part(cell.z)) >> 32;
    const int missing = int(hash % 3);
    const double u = missing == 0 ? offset.y : offset.x;
    const double v = missing == 2 ? offset.y : offset.z;
    return ((hash >> 8 & 1) ? -u : u) + ((hash >> 9 & 1) ? -v : v);
}

// Gradient noise: 0 at whole numbers, -1..1 (a little more at most) between.
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

// Octaves of half the size and half the strength each; the strengths add up to less than 1.
double fractalNoiseAt(std::uint64_t seed, glm::dvec3 p) {
    constexpr int kOctaves = 5;
    double sum = 0;
    double strength = 0.5;
    for (int octave = 0; octave < kOctaves; ++octave) {
        sum += strength * noiseAt(seed + std::uint64_t(octave), p);
        p *= 2.0;
        strength /= 2;
    }
    return sum;
}

}  // namespace

ValueAt makeCloud(std::uint64_t seed) {
    return [seed](const glm::dvec3& p) {
        // Noise pushes the surface of a ball in and out; density rises with depth below it.
        constexpr double kRadius = 0.6;
        constexpr double kReach = 0.36;
        constexpr double kFrequency = 2.5;  // lattice cells per unit, largest octave
        constexpr double kSkin = 0.3;       // depth of full density
        const double radius = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
        if (radius >= kRadius + kReach) return 0.0;
        const double noise = std::clamp(2 * fractalNoiseAt(seed, p * kFrequency), -1.0, 1.0);
        const double depth = kRadius - radius + kReach * noise;
        return std::clamp(depth / kSkin, 0.0, 1.0);
    };
}

}  // namespace deltasplat
