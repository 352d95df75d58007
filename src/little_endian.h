// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace deltasplat {

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
