// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/optics/class_table.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// Which of 64 voxels' colours are more than whole units: bit n for voxel n.
struct MoreDigits {
    std::uint64_t low = 0;     ///< they have a low digit
    std::uint64_t planes = 0;  ///< of these, they may be on the second plane: see digitsOf
};

/// Writes colours in digits of the first plane, as digitsOf (color_digits.h) does. The same bits at
/// every SIMD level.
/// @param high  [64]
/// @param low   [64]: where there is no low digit, nothing of consequence
MoreDigits writeDigits(const WordUnits& units, ClassTable::Color* high, ClassTable::Color* low);

}  // namespace deltasplat
