// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// Mirrors a matrix of 8x8 bits at its diagonal: bit 8 * i + j becomes bit 8 * j + i. Swaps ever
/// larger blocks, as in Henry Warren, Hacker's Delight, 2002, section 7-3.
inline std::uint64_t transposedBits(std::uint64_t bits) {
    const auto swap = [&](int shift, std::uint64_t mask) {
        const std::uint64_t moved = (bits ^ bits >> shift) & mask;
        bits ^= moved ^ moved << shift;
    };
    swap(7, 0x00AA00AA00AA00AA);
    swap(14, 0x0000CCCC0000CCCC);
    swap(28, 0x00000000F0F0F0F0);
    return bits;
}

}  // namespace deltasplat
