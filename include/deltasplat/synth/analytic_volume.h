// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A volume whose true value is known in closed form at every point.
struct AnalyticVolume {
    std::string name;
    /// Value 0..1 at a position; the volume fills the cube [-1, 1]^3 (x, y, z), whatever its dims.
    /// Deterministic and thread-safe.
    std::function<double(const glm::dvec3& position)> valueAt;
};

/// Returns the names that makeAnalytic knows: marschner-lobb, hydrogen, shepp-logan, engine, cloud,
/// slab.
const std::vector<std::string>& analyticNames();

/// Returns the volume called `name`.
/// @param seed   chooses the cloud's shape and the engine's noise; without effect on the others
/// @param noise  standard deviation of the engine's noise in units of the value range, 0 = none
/// @throw Error(kUsage) if there is no such name (listing those there are)
AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed = 1, double noise = 0);

}  // namespace deltasplat
