// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "formats/raw/raw_format.h"

namespace deltasplat {

template <std::size_t kBytes>
using BitsOf = std::conditional_t<
    kBytes == 1, std::uint8_t,
    std::conditional_t<kBytes == 2, std::uint16_t,
                       std::conditional_t<kBytes == 4, std::uint32_t, std::uint64_t>>>;

/// Returns the value whose bytes are at `from`, turned round if `swap`.
template <typename T>
inline T loadValue(const std::byte* from, bool swap) {
    using Bits = BitsOf<sizeof(T)>;
    Bits bits;
    std::memcpy(&bits, from, sizeof(T));
    if (swap) {
        // Compilers know this loop as one instruction.
        Bits turned = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            turned = Bits(turned | Bits(bits >> (8 * i) & 0xff) << (8 * (sizeof(T) - 1 - i)));
        }
        bits = turned;
    }
    return std::bit_cast<T>(bits);
}

/// Whether bytes of this order are not in the processor's.
constexpr bool mustSwap(bool bigEndian) {
    return bigEndian != (std::endian::native == std::endian::big);
}

/// Calls use(T{}) with the C++ type of `type`.
template <typename Use>
auto withRawType(RawType type, const Use& use) {
    switch (type) {
        case RawType::kUint8:
            return use(std::uint8_t{});
        case RawType::kInt8:
            return use(std::int8_t{});
        case RawType::kUint16:
            return use(std::uint16_t{});
        case RawType::kInt16:
            return use(std::int16_t{});
        case RawType::kUint32:
            return use(std::uint32_t{});
        case RawType::kInt32:
            return use(std::int32_t{});
        case RawType::kUint64:
            return use(std::uint64_t{});
        case RawType::kInt64:
            return use(std::int64_t{});
        case RawType::kFloat32:
            return use(float{});
        case RawType::kFloat64:
            break;
    }
    return use(double{});
}

}  // namespace deltasplat
