// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "volume/slot_blocks.h"

namespace deltasplat {

/// Which slots there may be.
struct SlotRules {
    std::uint32_t lowest = 1;  ///< of active voxels, inclusive; below 65536
    std::uint32_t highest = 0;
    std::uint32_t firstInactive = 0;  ///< of inactive voxels with values of their own
    std::uint32_t inactiveCount = 0;
    ShortSlot rest = 0;  ///< what empty slots are shown as
};

/// Adds the deltas of a slice of a block, as numbers without sign (zigzag.h), to the slots of the
/// voxels that a mask word names; modulo 2^32.
/// @param deltas  of these voxels alone, in the order of the word's bits
/// @param slots   [64]
void addDeltas(std::uint64_t word, const std::int32_t* deltas, std::uint32_t* slots);

/// Writes what 64 slots are shown as: those of inactive voxels as empty. Returns whether all of
/// them are empty, or what the rules allow. The same at every SIMD level, as all of these.
bool shortenSlots(const std::uint32_t* slots, const SlotRules& rules, ShortSlot* out);

/// What is in a block.
struct SlotRange {
    ShortSlot lowest;   ///< of those that are not empty; 0 if all are
    ShortSlot highest;  ///< 0 if all are empty
    bool hasEmpty;
};

/// @param slots  [512], below 65535
SlotRange rangeOf(const ShortSlot* slots);

}  // namespace deltasplat
