// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/delta/bit_reader.h"

namespace deltasplat {

/// Takes up to 64 Rice codes at once from planes, which hold the bits of equal weight of all
/// numbers (docs/delta-grid.md, "Packed deltas"). The same at every SIMD level.
/// @param parameter  below the code's width
/// @param count      of the numbers, 1..64
/// @param numbers    [64], filled up with zeros
/// @return mask of the numbers that are not 0
std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint32_t* numbers);
std::uint64_t takePlanes(BitReader& in, RiceCode code, int parameter, std::size_t count,
                         std::uint64_t* numbers);

}  // namespace deltasplat
