// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace deltasplat {

/// Stores a number as sizeof(T) bytes, least significant first, on any machine.
template <typename T>
inline void storeLittle(T value, std::byte* at) {
    using Bits = std::conditional_t<
        sizeof(T) == 1, std::uint8_t,
        std::conditional_t<sizeof(T) == 2, std::uint16_t,
                           std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
    const Bits bits = std::bit_cast<Bits>(value);
    // Compilers know this loop as one instruction.
    for (std::size_t i = 0; i < sizeof bits; ++i) at[i] = std::byte(bits >> 8 * i & 0xff);
}

}  // namespace deltasplat
