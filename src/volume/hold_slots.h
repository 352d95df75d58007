// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volume/code_blocks.h"

namespace deltasplat {

/// What the voxels of a column of blocks are held as, `[u][v]`; empty: as nothing.
using HeldSlots = std::array<Slot, 64>;

/// Takes a block's voxels slice by slice through what they are held as: each becomes
/// next(held, slot), compared with its true slot every time, and use(i, slot) gets it.
template <typename Next, typename Use>
void holdSlots(const BlockSlots& slots, HeldSlots& held, const Next& next, const Use& use) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Slot& slot = held[i & 63];
        slot = next(slot, slots[i]);
        use(i, slot);
    }
}

}  // namespace deltasplat
