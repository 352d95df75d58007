// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace deltasplat {

/// Extinction in a slice.
struct MetClasses {
    const float* extinctions;  ///< [classes]: per world unit, finite
    float step;                ///< world units of the light's way through a slice
    float most;                ///< beyond this extinction no light is left
};

/// A slice of a block on the swept plane: voxel (u, v) lies between rows u, u+1, columns v, v+1.
struct SweptPlace {
    float* first;  ///< row `begin`, column 0
    std::size_t pitch;
    int begin;        ///< rows before this one are skipped
    glm::vec2 share;  ///< of the way to the next row and column: 0..1
};

/// Extinctions are stored as square roots in 1 / kDepthSteps: fine where small, and up to 1023.
inline constexpr float kDepthSteps = 2048;

/// Looks up the extinctions of voxels. The same bits at every SIMD level, like the functions below.
/// @param own  [64]: extinction through the voxels of `classes`, [64]
/// @return whether there is any
bool lookUpMet(const MetClasses& met, const std::uint16_t* classes, float* own);
/// Reads the extinction on the way to voxels.
/// @param end    of rows of voxels, 0..8
/// @param codes  [64]: square roots, in 1 / kDepthSteps
void readSwept(const SweptPlace& place, int end, std::uint16_t* codes);
/// Adds the extinctions of voxels.
/// @param end  of rows of the plane, 0..9
/// @param own  [64]: needed for voxels between these rows
void addSwept(const SweptPlace& place, int end, const float* own);

}  // namespace deltasplat
