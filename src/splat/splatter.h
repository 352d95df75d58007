// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Everything that splatting a slab needs and does not change.
struct SplatInput {
    const DeltaGrid& grid;
    const ClassTable& classes;
    const StampWeights& weights;
    int footprintRadius;
    bool stampEmptyVoxels;  ///< stamp every voxel of the box, the empty ones too (method
                            ///< `traditional`); the grid must hold whole slices
};

/// Turns one slab into sheets: calls `eachSlice(slice, sheet)` for its slices in increasing order,
/// with the sheet complete and settled. Deltas are added to what the sheet holds; of a slab stored
/// whole, each slice starts anew.
/// @param sheet  all zero; left as the last slice made it
/// @return the number of stamps added
std::uint64_t splatSlab(const SplatInput& input, const Slab& slab, Sheet& sheet,
                        const std::function<void(int slice, const Sheet&)>& eachSlice);

}  // namespace deltasplat
