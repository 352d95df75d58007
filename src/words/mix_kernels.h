// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"
#include "words/mix_window.h"

namespace deltasplat {

/// Evenly spaced levels between codes, for ValueMixer.
struct EvenLevels {
    Code lowest = 0;  ///< the code of the first one
    int perCode = 0;  ///< a power of two; 0 if codes are not even
    int last = 0;     ///< the level of the last code
};

/// [slice]: bit 8 u + v of a block's 512 voxels.
using VoxelMasks = std::array<std::uint64_t, 8>;

/// Divides a block like ValueMixer::mix, for even levels. Returns the voxels that are more than
/// twice as opaque as all of their parts; possibly others if `rise` is true but wrong.
/// @param slotMap    [kSlotCount]: maps slots of levels
/// @param opacities  [kSlotCount]: of the mapped slots
/// @param rise       no level is less opaque than a lower one; faster
/// @param mixed      [parts.within along u][parts.slices][parts.within along v]
VoxelMasks mixEvenLevels(const MixWindow& window, const Subdivision& parts,
                         const EvenLevels& levels, const Slot* slotMap, const float* opacities,
                         bool rise, BlockSlots* mixed);

}  // namespace deltasplat
