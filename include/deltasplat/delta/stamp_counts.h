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
    /// For each slab `delta` if clearly less, else `sparse`; predicted as for voxels that have no
    /// looks of their own (shading, color by another grid), of which more slabs would be `sparse`.
    std::uint64_t automatic = 0;
};

/// Returns what `render` takes for a picture along a slice axis, without rendering or storing
/// deltas: exact for the slot map of its transfer function (see ClassTable::classOfSlot).
/// @param slotMap   as DeltaOptions::slotMap
/// @param oneDigit  as ClassTable::oneDigit(): few changes of two digits are not stamped
StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap = {},
                          bool oneDigit = true);

/// Returns the slot map that makes voxels of one value empty and keeps all others apart.
std::vector<Slot> slotsWithout(const CodeBook& codeBook, double value);

}  // namespace deltasplat
