// SPDX-License-Identifier: Apache-2.0
// Based on: CIE 15:2004 (L*a*b*), IEC 61966-2-1:1999 (sRGB's primaries), and Kenneth Moreland,
// "Diverging Color Maps for Scientific Visualization", 2009 (Msh).
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

/// Returns the scene-linear colour of CIE XYZ in shares of white's, so that (1, 1, 1) is white; it
/// may lie beyond what the primaries can mix: below 0.
glm::dvec3 linearFromShareOfWhite(const glm::dvec3& share);

/// CIE L*a*b* of a scene-linear colour of sRGB's primaries; white, (1, 1, 1), is (100, 0, 0).
glm::dvec3 labFromLinear(const glm::dvec3& rgb);
/// Returns the scene-linear colour, which may lie beyond what the primaries can mix: below 0.
glm::dvec3 linearFromLab(const glm::dvec3& lab);

/// L*a*b* in polar form: magnitude, saturation (angle from grey) and hue, in radians.
glm::dvec3 mshFromLab(const glm::dvec3& lab);
glm::dvec3 labFromMsh(const glm::dvec3& msh);

/// Hue 0..1, saturation 0..1 and value, the largest channel, of channels >= 0.
glm::dvec3 hsvFromRgb(const glm::dvec3& rgb);
glm::dvec3 rgbFromHsv(const glm::dvec3& hsv);

}  // namespace deltasplat
