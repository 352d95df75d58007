// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "rays/ray_volume.h"

namespace deltasplat {

/// The most voxels along an axis that are read as one.
inline constexpr int kMostVoxelsAsOne = 8;

/// Returns the volume with boxes of voxels as one voxel each, whose value is the mean of theirs,
/// 0 where none is active: for sums along the line of sight, which stay what they are.
/// @param fine   under RayRule::kSum
/// @param boxes  voxels along (slice, u, v): 1, 2, 4 or 8 each; boxes begin at multiples of them
RayVolume coarsened(RayVolume fine, const glm::ivec3& boxes);

/// Returns where such a voxel's index lies in the volume's own index space.
/// @param boxes  voxels along (x, y, z)
glm::dmat4 indexFromBoxes(const glm::ivec3& boxes);

}  // namespace deltasplat
