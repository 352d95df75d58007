// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// Stamps of a picture by each method.
struct StampCounts {
    std::uint64_t traditional = 0;  ///< voxels of the box
    std::uint64_t sparse = 0;       ///< visible voxels
    std::uint64_t delta = 0;        ///< deltas, key slices included
    /// Per slab the choice of `render` for undivided voxels with one-pixel footprints
    /// (hasOwnPixel): `delta` if a tenth fewer slices of 8x8x8 blocks have stamps, or it writes a
    /// quarter less (stamps, or thrice the rows of eight voxels with stamps if less), else
    /// `sparse`.
    std::uint64_t automatic = 0;
};

/// Returns the stamps of `render` along a slice axis, without rendering or storing deltas. Exact
/// for its slot map (ClassTable::classOfSlot); `automatic` only for one-pixel footprints.
/// @param slotMap  as DeltaOptions::slotMap
StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {});

/// Returns a slot map that makes voxels of one value empty and keeps all others apart.
std::vector<Slot> slotsWithout(const CodeBook& codeBook, double value);

}  // namespace deltasplat
