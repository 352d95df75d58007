// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "volume/slot_blocks.h"

namespace deltasplat {

/// The slots that may occur.
struct SlotRules {
    std::uint32_t lowest = 1;  ///< of active voxels, inclusive; below 65536
    std::uint32_t highest = 0;
    std::uint32_t firstInactive = 0;  ///< of inactive voxels with values of their own
    std::uint32_t inactiveCount = 0;
    ShortSlot rest = 0;  ///< replaces empty slots
};

/// Adds a slice's zigzag deltas (exact_slots.h) to the slots of the voxels in a mask word; modulo
/// 2^32. All kernels here give the same results at every SIMD level.
/// @param deltas  of these voxels alone, in the order of the word's bits
/// @param slots   [64]
void addDeltas(std::uint64_t word, const std::int32_t* deltas, std::uint32_t* slots);

/// Writes the shown values of 64 slots, inactive voxels as empty. Returns whether all are allowed.
bool shortenSlots(const std::uint32_t* slots, const SlotRules& rules, ShortSlot* out);

/// Range of a block's slots.
struct SlotRange {
    ShortSlot lowest;   ///< of slots that are not empty; 0 if all are empty
    ShortSlot highest;  ///< 0 if all are empty
    bool hasEmpty;
};

/// @param slots  [512], below 65535
SlotRange rangeOf(const ShortSlot* slots);

}  // namespace deltasplat
