// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "deltasplat/delta/delta_grid.h"
#include "volume/class_ramps.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// Compares the 64 slots of two slices of a block. Bit n of the result: slot n differs.
std::uint64_t differingSlots(const Slot* a, const Slot* b);

/// Compares each of a block's eight slices, `classes` [8][64], with the slice before; the first
/// with `before` [64]. Bit n of visible[s]: voxel n is not 0. Bit n of changed[s]: voxel n differs.
void compareClasses(const std::uint16_t* before, const std::uint16_t* classes,
                    std::uint64_t* visible, std::uint64_t* changed);

std::uint64_t countBits(std::span<const std::uint64_t> masks);

/// Writing a row of eight voxels takes as long as writing this many single voxels.
inline constexpr int kVoxelsOfRow = 3;

/// Counts over masks of 64 voxels.
struct MaskCounts {
    std::uint64_t voxels = 0;
    std::uint64_t words = 0;  ///< masks with any voxel
    /// Estimated time to write the voxels, in single voxels: per mask all voxels or all non-empty
    /// rows, whichever is faster. (Whole slices always use rows, but sparse ones measure so:
    /// docs/decisions.md.)
    std::uint64_t writes = 0;
};
MaskCounts countMasks(std::span<const std::uint64_t> masks);

/// Writes the classes of a leaf's 512 codes, `[x][y][z]`, in slice order, `[slice][u][v]`.
void classesOfLeaf(const ClassRamp& ramp, const Code* codes, int sliceAxis, ClassIndex* classes);

/// Writes the classes of a block's 512 slots in the same order. A slot is 0 or code + 1.
void classesOfSlots(const ClassRamp& ramp, const ShortSlot* slots, ClassIndex* classes);

}  // namespace deltasplat
