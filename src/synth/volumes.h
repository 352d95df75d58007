// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "deltasplat/synth/analytic_volume.h"

namespace deltasplat {

/// A volume's value 0..1 at a position in [-1, 1]^3.
using ValueAt = std::function<double(const glm::dvec3& position)>;

// One function for each name of analyticNames().
ValueAt makeMarschnerLobb();
ValueAt makeHydrogen();
ValueAt makeSheppLogan();
ValueAt makeEngine(std::uint64_t seed, double noise);
ValueAt makeCloud(std::uint64_t seed);
ValueAt makeSlab();
ValueAt makeVessels(std::uint64_t seed, double noise);
ValueAt makeBody();
AnalyticVolume makeFire(std::uint64_t seed);
AnalyticVolume makeExplosion(std::uint64_t seed);

}  // namespace deltasplat
