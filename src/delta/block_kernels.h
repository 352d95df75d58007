// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// Compares the 64 slots of two slices of a block; bit n is set where slot n differs.
std::uint64_t differingSlots(const Slot* a, const Slot* b);

}  // namespace deltasplat
