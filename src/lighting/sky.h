// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns the scene-linear colour of CIE XYZ, where sunlight above the atmosphere of Y 1 is white,
/// (1, 1, 1). What the primaries cannot mix is 0.
glm::dvec3 colorUnderSun(const glm::dvec3& xyz);

/// Returns the colour of sunlight, which is white above the atmosphere, on the ground.
/// @param zenithAngle  of the sun, in radians, 0..pi/2
glm::dvec3 sunColor(double zenithAngle, double turbidity);

}  // namespace deltasplat
