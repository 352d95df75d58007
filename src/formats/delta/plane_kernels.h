// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/delta/bit_reader.h"

namespace deltasplat {

/// Takes Rice codes that lie in planes: of all numbers the bits of equal weight, one behind the
/// other (docs/delta-grid.md, "Packed deltas"). So 64 numbers are taken together. The same at every
/// SIMD level.
/// @param parameter  below the code's width
/// @param count      of the numbers, 1..64
/// @param numbers    [64], those behind `count` become 0
/// @return which of them are not 0
std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint32_t* numbers);
std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint64_t* numbers);

}  // namespace deltasplat
