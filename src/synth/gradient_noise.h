// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns gradient noise: 0 at whole numbers, -1..1 (a little more at most) between.
double noiseAt(std::uint64_t seed, const glm::dvec3& p);

/// Returns octaves of noise added up, each half the size and a little less than half the strength
/// of the one before: about -1..1, 0 on average.
double fractalAt(std::uint64_t seed, glm::dvec3 p, int octaves);

/// Returns a vector of three such sums, one for each axis: by so much turbulence carries a place.
glm::dvec3 turbulenceAt(std::uint64_t seed, const glm::dvec3& p, int octaves);

/// Returns octaves folded at 0, so that a surface moved by them bulges between creases as a cumulus
/// does: 0 in the deepest crease, 1 (clamped) on the highest bulge.
double billowAt(std::uint64_t seed, glm::dvec3 p);

}  // namespace deltasplat
