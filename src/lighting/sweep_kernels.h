// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace deltasplat {

/// What light meets in a slice.
struct MetClasses {
    const float* extinctions;  ///< [classes]: in a world unit, finite
    float step;                ///< world units that light travels in a slice
    float most;                ///< beyond which nothing of it is left
};

/// Where a block's voxels of a slice lie on the plane of what light has come through: voxel (u, v)
/// between rows u and u + 1, columns v and v + 1.
struct SweptPlace {
    float* first;  ///< row `begin`, column 0
    std::size_t pitch;
    int begin;        ///< rows before it are left out
    glm::vec2 share;  ///< of the way from a row, or column, to the next: 0..1
};

/// Extinctions are stated by the square root, in 1 / kDepthSteps: finely where little is met, and
/// up to 1023.
inline constexpr float kDepthSteps = 2048;

/// Looks up what light meets in the voxels of a slice of a block. The same bits at every SIMD
/// level, as those below.
/// @param classes  [64]
/// @param own      [64]: extinction on the way through
/// @return whether there is any
bool lookUpMet(const MetClasses& met, const std::uint16_t* classes, float* own);
/// Reads what light has come through before it comes to voxels.
/// @param end    of rows of voxels, 0..8
/// @param codes  [64]: square roots, in 1 / kDepthSteps
void readSwept(const SweptPlace& place, int end, std::uint16_t* codes);
/// Adds what light comes through in voxels.
/// @param end  of rows of the plane, 0..9
/// @param own  [64]: those that these rows lie between have to be there
void addSwept(const SweptPlace& place, int end, const float* own);

}  // namespace deltasplat
