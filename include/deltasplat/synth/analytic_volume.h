// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// A further grid of a volume that has several: what is there besides its density.
struct AnalyticGrid {
    std::string name;
    /// Value at a position, in the grid's own unit; else as AnalyticVolume::valueAt.
    std::function<double(const glm::dvec3& position)> valueAt;
    /// What is not above it does not matter: a file leaves it out, as 0.
    double threshold = 0;
};

/// A volume whose true value is known in closed form at every point.
struct AnalyticVolume {
    std::string name;
    /// Value 0..1 at a position; the volume fills the cube [-1, 1]^3 (x, y, z), whatever its dims.
    /// Deterministic and thread-safe.
    std::function<double(const glm::dvec3& position)> valueAt;
    std::vector<AnalyticGrid> others = {};  ///< at the same places
    /// Scene-linear colour (r, g, b), each 0..1, at a position; matters where the value is not 0.
    /// Empty: the volume has none. Deterministic and thread-safe.
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
///   are `temperature` (300 to 2200 kelvin, 500 and less left out) and `flame` (0..1). Where there
///   is flame it has 800 K or more, where there are more than 1200 K there is flame, and where that
///   is 0.5 or more there is no smoke
/// - explosion: a seeded ball of thick smoke, all lumps, whose core and cracks are hot:
/// `temperature`
///   as of the fire, and a colour, from scorched brown to grey (red >= green >= blue)
const std::vector<std::string>& analyticNames();

/// Returns the volume called `name`.
/// @param seed   chooses the shape of cloud, vessels, fire and explosion, and noise; without effect
///               on the others
/// @param noise  standard deviation of the engine's and the vessels' noise in units of the value
///               range, 0 = none; noisy values are clamped to 0..1; without effect on the others
/// @throw Error(kUsage) if there is no such name (listing those there are), or if the noise is
/// negative or not finite
AnalyticVolume makeAnalytic(const std::string& name, std::uint64_t seed = 1, double noise = 0);

}  // namespace deltasplat
