// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deltasplat/optics/class_table.h"
#include "optics/voxel_units.h"

namespace deltasplat {

/// Which of 64 voxels' colours need more than one digit: bit n for voxel n.
struct MoreDigits {
    std::uint64_t low = 0;     ///< the colour has a low digit
    std::uint64_t planes = 0;  ///< of these, the colour may be on the second plane (digitsOf)
};

/// Splits colours into digits of the first plane (digitsOf). The same bits at every SIMD level.
/// @param high  [64]
/// @param low   [64]: undefined where there is no low digit
MoreDigits writeDigits(const WordUnits& units, ClassTable::Color* high, ClassTable::Color* low);

}  // namespace deltasplat
