// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// Returns a delta as a number without sign: 0, -1, 1, -2, ... become 0, 1, 2, 3, ... Blosc puts
/// bytes of equal weight together, and the upper ones of small negative numbers would be no zeros.
inline std::int32_t toZigzag(std::int32_t delta) {
    return std::int32_t((std::uint32_t(delta) << 1) ^ std::uint32_t(delta >> 31));
}

/// Returns the delta that toZigzag made a number of; any number is one's.
inline std::int32_t fromZigzag(std::int32_t number) {
    const auto bits = std::uint32_t(number);
    return std::int32_t((bits >> 1) ^ (0u - (bits & 1u)));
}

}  // namespace deltasplat
