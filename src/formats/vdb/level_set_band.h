// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/ingest/read_volume.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Activates the voxels of a level set that a surface needs but the band lacks, because a cut voxel
/// shows the voxels behind. Inactive negative voxels are inside, as in OpenVDB. New distances
/// continue the band. A band that is wide enough on both sides stays unchanged. Deterministic.
/// @param grid  of floats or doubles
/// @return number of new voxels beside the surface; those that only fill the inside do not count
std::uint64_t completeBand(TreeGrid& grid, const LevelSetSurface& surface);

}  // namespace deltasplat
