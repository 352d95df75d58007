// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace deltasplat {

/// Returns where to begin looking for `bits` in an open hash table of `size` places, a power of two
/// from 2 on.
inline std::size_t hashPlace(std::uint64_t bits, std::size_t size) {
    constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio (D. Knuth)
    // Doubles that are whole numbers have zeros at the end, which multiplication keeps.
    return std::size_t((bits ^ (bits >> 32)) * kSpread >> (65 - std::bit_width(size)));
}

}  // namespace deltasplat
