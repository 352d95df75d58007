// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "deltasplat/delta/delta_grid.h"
#include "volume/class_ramps.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// Compares the 64 slots of two slices of a block; bit n is set where slot n differs.
std::uint64_t differingSlots(const Slot* a, const Slot* b);

/// Compares the eight slices of a block, `classes` [8][64], each with the one before it, the first
/// with `before` [64]. Bit n of visible[s] is set where voxel n of slice s is not 0, of changed[s]
/// where it differs.
void compareClasses(const std::uint16_t* before, const std::uint16_t* classes,
                    std::uint64_t* visible, std::uint64_t* changed);

/// Returns how many bits are set in all masks together.
std::uint64_t countBits(std::span<const std::uint64_t> masks);

/// A row of eight voxels takes as long to be written as so many voxels one by one.
inline constexpr int kVoxelsOfRow = 3;

/// What masks of 64 voxels have.
struct MaskCounts {
    std::uint64_t voxels = 0;
    std::uint64_t words = 0;  ///< masks that have any
    /// About how long they take to be written to pixels of their own: as long as so many that are
    /// written one by one, which all of a mask are, or, if it is less, the rows that have any.
    /// (Whole slices are written in rows always, but those of few voxels measure as if they were
    /// not: docs/decisions.md.)
    std::uint64_t writes = 0;
};
MaskCounts countMasks(std::span<const std::uint64_t> masks);

/// Writes the classes of the 512 codes of a leaf, `[x][y][z]`, as they lie along a slice axis,
/// `[slice][u][v]`.
void classesOfLeaf(const ClassRamp& ramp, const Code* codes, int sliceAxis, ClassIndex* classes);

/// Writes the classes of the 512 slots of a block in their order: 0, or a code and one.
void classesOfSlots(const ClassRamp& ramp, const ShortSlot* slots, ClassIndex* classes);

}  // namespace deltasplat
