// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/tolerance.h"

namespace deltasplat {

/// Replaces codes of a volume so that along the slice axis a voxel keeps the value it has as long
/// as that is within tolerance of the true one (compared with the true one each time, so that
/// errors never add up). Holding starts anew where a slab does. Inactive voxels stay inactive, and
/// voxels that `slotMap` makes empty neither hold nor are held. What the code book's values may be
/// off is taken off the tolerance. Deterministic; multi-threaded.
void holdValues(Volume& volume, int sliceAxis, int keyInterval, const Tolerance& tolerance,
                std::span<const Slot> slotMap);

}  // namespace deltasplat
