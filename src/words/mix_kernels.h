// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"
#include "words/mix_window.h"

namespace deltasplat {

/// Levels that lie evenly between codes: as ValueMixer has them.
struct EvenLevels {
    Code lowest = 0;  ///< the code of the first one
    int perCode = 0;  ///< a power of two; 0 if codes are not even
    int last = 0;     ///< the level of the last code
};

/// Of the 512 voxels of a block, bit 8 u + v of [slice].
using VoxelMasks = std::array<std::uint64_t, 8>;

/// Mixes the blocks that a block becomes, where levels are even, as ValueMixer::mix does, and
/// returns the voxels that are more than twice as opaque as anything that they become, and others
/// where `rise` is said and not so.
/// @param slotMap    [kSlotCount]: what becomes of the slots of levels
/// @param opacities  [kSlotCount]: of that
/// @param rise       whether no level has less opacity than one below it, which is quicker
/// @param mixed      [parts.within along u][parts.slices][parts.within along v]
VoxelMasks mixEvenLevels(const MixWindow& window, const Subdivision& parts,
                         const EvenLevels& levels, const Slot* slotMap, const float* opacities,
                         bool rise, BlockSlots* mixed);

}  // namespace deltasplat
