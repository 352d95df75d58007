// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace deltasplat {

/// Returns whether two values are the same, bit for bit: 0 and -0 are not, a NaN and itself are.
template <typename T>
bool haveSameBits(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
        return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
    } else {
        return a == b;
    }
}

/// Returns the value of type T nearest to `value`: whole numbers rounded, what is beyond the type's
/// range its end, NaN 0 for types without one. A plain cast of such values has no defined result.
template <typename T>
T valueAs(double value) {
    if constexpr (std::is_same_v<T, double>) {
        return value;
    } else if constexpr (std::is_same_v<T, bool>) {
        return value != 0;
    } else if constexpr (std::is_floating_point_v<T>) {
        if (!std::isfinite(value)) return T(value);
        constexpr auto kMost = double(std::numeric_limits<T>::max());
        return T(std::clamp(value, -kMost, kMost));
    } else {
        // The end itself may be no double, the number after it is: a power of two.
        const double beyond = std::ldexp(1.0, std::numeric_limits<T>::digits);
        const double rounded = std::nearbyint(value);
        if (std::isnan(value)) return T{0};
        if (rounded >= beyond) return std::numeric_limits<T>::max();
        if (rounded < double(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
        return T(rounded);
    }
}

}  // namespace deltasplat
