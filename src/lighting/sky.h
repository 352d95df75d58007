// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns the scene-linear colour of CIE XYZ, where sunlight of Y 1 above the atmosphere is white,
/// (1, 1, 1). Channels outside the gamut are 0.
glm::dvec3 colorUnderSun(const glm::dvec3& xyz);

/// Returns the colour of sunlight on the ground; above the atmosphere it is white.
/// @param zenithAngle  of the sun, in radians, 0..pi/2
glm::dvec3 sunColor(double zenithAngle, double turbidity);

}  // namespace deltasplat
