// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "deltasplat/optics/environment.h"
#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// A clear daytime sky seen from the ground (Preetham, Shirley and Smits 1999). With the sun near
/// the horizon it is several times brighter than measured skies. From a turbidity of 6 on the model
/// is extrapolated: with a high sun more light arrives below than above the atmosphere. Colours and
/// strengths are relative to sunlight above the atmosphere, which is white: strength 1, 133 klx.
struct Sky {
    glm::dvec3 towardsSun{0, 1, 0};  ///< in the world, of any length but 0
    glm::dvec3 up{0, 1, 0};          ///< in the world, of any length but 0
    /// Scattering of air and haze over that of air: kLeastTurbidity (clear)..kMostTurbidity (hazy).
    double turbidity = 3;
    double strength = 1;           ///< of sunlight above the atmosphere, 0..kMostLight
    glm::dvec3 groundAlbedo{0.2};  ///< share of light that the ground sends back, each 0..1
};

inline constexpr double kLeastTurbidity = 2;
inline constexpr double kMostTurbidity = 10;

/// Returns the sky without the sun itself, and below the horizon the ground, lit by sky and sun.
/// The picture's middle lies below or above the sun. Multi-threaded, deterministic.
/// @throw Error(kUsage) if a member is out of range, or the sun below the horizon: no twilight
Environment skyEnvironment(const Sky& sky);

/// Returns the sun in the colour that the atmosphere lets through, 0 below the horizon.
/// @throw Error(kUsage) if a member is out of range
Light sunLight(const Sky& sky);

}  // namespace deltasplat
