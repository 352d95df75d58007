// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "deltasplat/optics/medium.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

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
