// SPDX-License-Identifier: Apache-2.0
// Based on: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014: the
// finalizer of SplitMix64.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "synth/volumes.h"

namespace deltasplat {

/// Scrambles 64 bits by a bijection.
constexpr std::uint64_t mixBits(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

constexpr std::uint64_t hash3(std::uint64_t seed, std::uint64_t x, std::uint64_t y,
                              std::uint64_t z) {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
    std::uint64_t hash = mixBits(seed + kGolden);
    for (const std::uint64_t part : {x, y, z}) hash = mixBits((hash ^ part) + kGolden);
    return hash;
}

/// Returns a number in [0, 1) from the upper bits of `hash`.
constexpr double unitFromBits(std::uint64_t hash) {
    return double(hash >> 11) * 0x1p-53;
}

/// A sequence of numbers in [0, 1) determined by a seed.
class UnitSequence {
  public:
    explicit UnitSequence(std::uint64_t seed) : hash_(mixBits(seed)) {}

    double next() {
        hash_ = mixBits(hash_ + 1);
        return unitFromBits(hash_);
    }

  private:
    std::uint64_t hash_;
};

/// Adds normally distributed noise to a volume and clamps to 0..1.
/// @param noise  standard deviation; 0 changes nothing
ValueAt withNoise(ValueAt valueAt, std::uint64_t seed, double noise);

/// Returns gradient noise: 0 at whole numbers, -1..1 (a little more at most) between.
double noiseAt(std::uint64_t seed, const glm::dvec3& p);

/// Returns a sum of noise octaves, each half the size and slightly less than half the strength of
/// the one before: about -1..1, 0 on average.
double fractalAt(std::uint64_t seed, glm::dvec3 p, int octaves);

/// Returns three such sums, the displacement of a point by turbulence.
glm::dvec3 turbulenceAt(std::uint64_t seed, const glm::dvec3& p, int octaves);

/// Returns octaves folded at 0. A surface moved by them bulges between creases like a cumulus: 0 in
/// the deepest crease, 1 (clamped) on the highest bulge.
double billowAt(std::uint64_t seed, glm::dvec3 p);

}  // namespace deltasplat
