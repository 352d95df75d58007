// SPDX-License-Identifier: Apache-2.0
// Based on: CIE 15:2004 (L*a*b*), IEC 61966-2-1:1999 (sRGB's primaries), and Kenneth Moreland,
// "Diverging Color Maps for Scientific Visualization", 2009 (Msh).
#pragma once

#include <array>
#include <cstdint>
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

}  // namespace deltasplat
