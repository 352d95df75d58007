// SPDX-License-Identifier: Apache-2.0
// Based on: CIE 15:2004 (L*a*b*), IEC 61966-2-1:1999 (sRGB's primaries), and Kenneth Moreland,
// "Diverging Color Maps for Scientific Visualization", 2009 (Msh).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/optics/medium.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns the scene-linear colour of CIE XYZ given in shares of white's, so that (1, 1, 1) is
/// white. Channels of colours outside the gamut are below 0.
glm::dvec3 linearFromShareOfWhite(const glm::dvec3& share);

/// CIE L*a*b* of a scene-linear colour of sRGB's primaries; white, (1, 1, 1), is (100, 0, 0).
glm::dvec3 labFromLinear(const glm::dvec3& rgb);
/// Returns the scene-linear colour; channels of colours outside the gamut are below 0.
glm::dvec3 linearFromLab(const glm::dvec3& lab);

/// L*a*b* in polar form: magnitude, saturation (angle from grey) and hue, in radians.
glm::dvec3 mshFromLab(const glm::dvec3& lab);
glm::dvec3 labFromMsh(const glm::dvec3& msh);

/// Hue 0..1, saturation 0..1 and value, the largest channel, of channels >= 0.
glm::dvec3 hsvFromRgb(const glm::dvec3& rgb);
glm::dvec3 rgbFromHsv(const glm::dvec3& hsv);

/// Colour grids are clamped to this, so that an outlier does not spoil other colours' precision.
inline constexpr double kBrightestColor = 16;

/// A factor for a volume's own colour, as looks store it: square roots of shares of the largest
/// factor, 11 bits each for red and green, 10 for blue.
struct ColorFactor {
    static glm::dvec3 largestOf(const ColorGrids& grids);

    /// @param share  of the largest factor, per channel; clamped to 0..1
    static std::uint32_t packed(const glm::dvec3& share);
    static glm::vec3 unpacked(std::uint32_t bits);
};

/// Returns the bits of a look's colour factor, which follow those of the part's look.
inline std::uint32_t factorBits(const OwnLook& look) {
    return look.bits[1] | std::uint32_t(look.bits[2]) << 16;
}

/// Colour factors of 64 voxels, by channel (RGB): shares of the largest factor.
using WordFactors = std::array<std::array<float, 64>, 3>;

/// @param looks  [64]
WordFactors factorsOf(const OwnLook* looks);

/// Returns the CIE 1931 chromaticity (x, y) of a black body.
/// @param kelvin  > 0; clamped to 1000..15000
glm::dvec2 blackbodyChromaticity(double kelvin);

/// Returns a black body's colour: linear sRGB of luminance 1, negative channels cut off.
glm::dvec3 blackbodyColor(double kelvin);

/// Black bodies colder than this do not glow visibly.
inline constexpr double kDarkKelvin = 500;

/// Returns a black body's glow per unit distance: sigma T^4 / pi times its colour, in megawatts per
/// square metre and steradian. Fades out from 798 K (Draper) to kDarkKelvin.
glm::dvec3 blackbodyGlow(double kelvin);

}  // namespace deltasplat
