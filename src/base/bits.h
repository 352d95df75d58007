// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace deltasplat {

/// Returns a / b rounded down, for b > 0.
constexpr int floorDiv(int a, int b) {
    return a / b - (a % b != 0 && a < 0);
}

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

/// Returns which rows of a matrix of 8x8 bits have any bit set: bit i for row i, bits 8 * i + j.
inline std::uint8_t rowsWithAny(std::uint64_t bits) {
    // The highest bit of each byte says whether the byte is not zero; then the eight move together.
    constexpr std::uint64_t kLow = 0x7F7F7F7F7F7F7F7F;
    const std::uint64_t any = (((bits & kLow) + kLow) | bits) & ~kLow;
    return std::uint8_t((any >> 7) * 0x0102040810204080 >> 56);
}

/// Stores a number as sizeof(T) bytes, least significant first, on any machine.
template <typename T>
inline void storeLittle(T value, std::byte* at) {
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(at, &value, sizeof value);
    } else {
        std::array<std::byte, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        std::reverse_copy(bytes.begin(), bytes.end(), at);
    }
}

}  // namespace deltasplat
