// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "deltasplat/optics/environment.h"
#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// A clear sky by day, as on the ground (Preetham, Shirley and Smits 1999). With the sun near the
/// horizon it is several times brighter than measured ones, and from a turbidity of 6 on, where the
/// model is extrapolated, sky and a high sun send down more than arrives above. Colours and
/// strengths are relative to sunlight above the atmosphere, which is white: a light of strength 1
/// and 133 klx.
struct Sky {
    glm::dvec3 towardsSun{0, 1, 0};  ///< in the world, of any length but 0
    glm::dvec3 up{0, 1, 0};          ///< in the world, of any length but 0
    /// Haze: how much more air and haze scatter than air alone would; kLeastTurbidity (very clear)
    /// to kMostTurbidity (hazy).
    double turbidity = 3;
    double strength = 1;           ///< of sunlight above the atmosphere, 0..kMostLight
    glm::dvec3 groundAlbedo{0.2};  ///< share of light that the ground sends back, each 0..1
};

inline constexpr double kLeastTurbidity = 2;
inline constexpr double kMostTurbidity = 10;

/// Returns the sky without the sun itself, and below the horizon the ground, lit by sky and sun.
/// The middle of the picture lies below or above the sun. Multi-threaded, deterministic.
/// @throw Error(kUsage) if a member is out of range, or the sun below the horizon: the model knows
///        no twilight
Environment skyEnvironment(const Sky& sky);

/// Returns the sun: its colour is what the atmosphere lets through, 0 if it is below the horizon.
/// @throw Error(kUsage) if a member is out of range
Light sunLight(const Sky& sky);

}  // namespace deltasplat
