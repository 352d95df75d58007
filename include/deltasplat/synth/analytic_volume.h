// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A further grid of a volume, beside its density.
struct AnalyticGrid {
    std::string name;
    /// Value at a position, in the grid's own unit; else as AnalyticVolume::valueAt.
    std::function<double(const glm::dvec3& position)> valueAt;
    /// Values up to the threshold do not matter: files leave them out, as 0.
    double threshold = 0;
};

/// A volume whose true value is known in closed form at every point.
struct AnalyticVolume {
    std::string name;
    /// Value 0..1 in the cube [-1, 1]^3 (x, y, z), whatever dims. Deterministic, thread-safe.
    std::function<double(const glm::dvec3& position)> valueAt;
    std::vector<AnalyticGrid> others = {};  ///< at the same places
    /// Scene-linear colour (r, g, b), each 0..1, at a position with a value other than 0. Empty:
    /// none. Deterministic and thread-safe.
    std::function<glm::dvec3(const glm::dvec3& position)> colorAt = {};
};

/// Returns the names that makeAnalytic knows:
/// - marschner-lobb: the reconstruction test signal of Marschner and Lobb (1994), with f_M = 6 and
///   alpha = 0.25; no empty space
/// - hydrogen: probability density of hydrogen's 3d orbital with m = 0, its largest value being 1;
///   the cube's half edge is 20 Bohr radii; two lobes along y and a ring; no empty space
/// - shepp-logan: the head phantom as ellipsoids, with the contrasts of Toft (1996); the face looks
///   along +y, z goes up the neck; plateaus of 0, 0.2, 0.3, 0.4 and 1
/// - engine: a two-cylinder engine of aluminium (0.45) and steel (0.9), cylinders along y, crank
///   shaft along x; optional noise
/// - cloud: seeded fractal fog of gradient noise; 0 outside a ball-like region
/// - slab: 1 where |x| <= 0.8, |y| <= 0.8 and |z| <= 0.5, 0 elsewhere
/// - vessels: a seeded tree of vessels that fork, as in an angiography; about 1 % of the cube is
///   not 0, rising from each wall to 1 half a radius below it; optional noise
/// - body: organs of a body as labels, value = label / 255: 1 skin, 2 bones, 3 lungs, 4 heart,
///   5 liver, 6 stomach, 7 kidneys, 8 spleen, 9 bowels, 10 brain, 11 aorta; y goes up to the head,
///   the face looks along +z
/// - fire: a seeded plume that burns below and smokes above, y being up. The value is smoke; others
///   are `temperature` (300 to 2200 kelvin, 500 and less left out) and `flame` (0..1). Flames have
///   at least 800 K, more than 1200 K are in flames, and flames of 0.5 or more have no smoke
/// - explosion: a seeded ball of thick smoke, all lumps, with hot core and cracks: `temperature`
///   like the fire's, and a colour, from scorched brown to grey (red >= green >= blue)
const std::vector<std::string>& analyticNames();

/// Returns the volume called `name`.
/// @param seed   shape of cloud, vessels, fire and explosion, and noise; no effect on others
/// @param noise  standard deviation of the engine's and the vessels' noise in units of the value
///               range, 0 = none; noisy values are clamped to 0..1; no effect on others
/// @throw Error(kUsage) for an unknown name (listing all), or a noise negative or not finite
AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed = 1, double noise = 0);

}  // namespace deltasplat
