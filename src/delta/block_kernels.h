// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// Compares the 64 slots of two slices of a block; bit n is set where slot n differs.
std::uint64_t differingSlots(const Slot* a, const Slot* b);

/// Compares the eight slices of a block, `classes` [8][64], each with the one before it, the first
/// with `before` [64]. Bit n of visible[s] is set where voxel n of slice s is not 0, of changed[s]
/// where it differs.
void compareClasses(const std::uint16_t* before, const std::uint16_t* classes,
                    std::uint64_t* visible, std::uint64_t* changed);

}  // namespace deltasplat
