// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// How many stamps a picture takes by each method.
struct StampCounts {
    std::uint64_t traditional = 0;  ///< voxels of the box
    std::uint64_t sparse = 0;       ///< visible voxels
    std::uint64_t delta = 0;        ///< deltas, those of key slices included
    /// For each slab `delta` if fewer of its slices of 8x8x8 blocks have any to stamp, by a tenth,
    /// or if these take less writing by a quarter (stamps, or thrice the rows of eight voxels that
    /// have any, if that is less), else `sparse`: what `render` takes of undivided voxels where
    /// footprints have one pixel (hasOwnPixel).
    std::uint64_t automatic = 0;
};

/// Returns what `render` takes for a picture along a slice axis, without rendering or storing
/// deltas: exact (but for `automatic` of others) for the slot map of its transfer
/// function (see ClassTable::classOfSlot).
/// @param slotMap  as DeltaOptions::slotMap
StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {});

/// Returns the slot map that makes voxels of one value empty and keeps all others apart.
std::vector<Slot> slotsWithout(const CodeBook& codeBook, double value);

}  // namespace deltasplat
