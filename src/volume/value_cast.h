// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace deltasplat {

/// Compares bit for bit: 0 and -0 differ, a NaN equals itself.
template <typename T>
bool haveSameBits(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
        return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
    } else {
        return a == b;
    }
}

/// Returns the value of type T nearest to `value`. Rounds for whole types, clamps to the type's
/// range, and returns 0 for NaN if T has none. A plain cast is undefined for such values.
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
        // The maximum of T may be no double, but the next number is one: a power of two.
        const double beyond = std::ldexp(1.0, std::numeric_limits<T>::digits);
        const double rounded = std::nearbyint(value);
        if (std::isnan(value)) return T{0};
        if (rounded >= beyond) return std::numeric_limits<T>::max();
        if (rounded < double(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
        return T(rounded);
    }
}

}  // namespace deltasplat
