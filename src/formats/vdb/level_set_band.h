// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/ingest/read_volume.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Makes those voxels of a level set active that a surface of it needs and that its band has not:
/// a voxel that the surface cuts lets through what lies behind, which has to be there. What is not
/// active is inside where it is negative, as OpenVDB has it. How far, is continued from the band.
/// Where the band reaches far enough to both sides nothing changes. Deterministic.
/// @param grid  of floats or doubles
/// @return how many voxels beside the surface became active, those that only fill it not counted
std::uint64_t completeBand(TreeGrid& grid, const LevelSetSurface& surface);

}  // namespace deltasplat
