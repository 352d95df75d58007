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

/// Colours of grids beyond this are taken for it, so that an outlier spoils no others.
inline constexpr double kBrightestColor = 16;

/// A colour that a volume's own is multiplied by, as looks keep it: square roots of shares of the
/// largest, 11 bits of red and green and 10 of blue.
struct ColorFactor {
    static glm::dvec3 largestOf(const ColorGrids& grids);

    /// @param share  of the largest of each channel; what is not within 0..1 is clamped
    static std::uint32_t packed(const glm::dvec3& share);
    static glm::vec3 unpacked(std::uint32_t bits);
};

/// Where looks keep a colour factor: behind the part's look.
inline std::uint32_t factorBits(const OwnLook& look) {
    return look.bits[1] | std::uint32_t(look.bits[2]) << 16;
}

/// Colour factors of 64 voxels as channels, RGB: shares of the largest.
using WordFactors = std::array<std::array<float, 64>, 3>;

/// @param looks  [64]
WordFactors factorsOf(const OwnLook* looks);

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
