// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns the CIE 1931 chromaticity (x, y) of a black body. Below 1000 K it is that of 1000 K,
/// above 15000 K that of 15000 K.
/// @param kelvin  > 0
glm::dvec2 blackbodyChromaticity(double kelvin);

/// Returns the colour of a black body: linear sRGB of luminance 1; what lies outside of sRGB is cut
/// off, as deep reds are.
glm::dvec3 blackbodyColor(double kelvin);

/// Nothing colder is seen to glow.
inline constexpr double kDarkKelvin = 500;

/// Returns what a black body adds to a ray on a unit distance: sigma T^4 / pi, in megawatts a
/// square metre and steradian, times its colour. From Draper's point, 798 K, down to kDarkKelvin it
/// fades out, for it is not seen.
glm::dvec3 blackbodyGlow(double kelvin);

}  // namespace deltasplat
