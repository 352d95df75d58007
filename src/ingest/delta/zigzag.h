// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

namespace deltasplat {

/// Returns a delta (int32 or int64) as a number without sign: 0, -1, 1, -2, ... become 0, 1, 2, 3,
/// ... Blosc puts bytes of equal weight together, and the upper ones of small negative numbers
/// would be no zeros.
template <typename Delta>
Delta toZigzag(Delta delta) {
    using Bits = std::make_unsigned_t<Delta>;
    return Delta((Bits(delta) << 1) ^ Bits(delta >> (8 * sizeof(Delta) - 1)));
}

/// Returns the delta that toZigzag made a number of; any number is one's.
template <typename Delta>
Delta fromZigzag(Delta number) {
    using Bits = std::make_unsigned_t<Delta>;
    const auto bits = Bits(number);
    return Delta((bits >> 1) ^ (Bits{0} - (bits & 1u)));
}

}  // namespace deltasplat
