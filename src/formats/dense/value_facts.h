// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "deltasplat/ingest/volume.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// What the finite values of a volume have in common: which types hold all of them.
struct ValueFacts {
    double min = 0;
    double max = 0;
    bool any = false;
    bool whole = true;         ///< whole numbers, none of them -0
    bool floats = true;        ///< a float holds every value
    bool ints = true;          ///< an int64 holds every value
    bool unsignedInts = true;  ///< an uint64 holds every value
    double doubleError = 0;    ///< largest difference between a value and its nearest double

    template <typename T>
    void add(T value) {
        const auto number = double(value);
        if (!std::isfinite(number)) return;
        min = any ? std::min(min, number) : number;
        max = any ? std::max(max, number) : number;
        any = true;
        if constexpr (std::is_floating_point_v<T>) {
            whole = whole && number == std::floor(number) && (number != 0 || !std::signbit(number));
        }
        floats = floats && double(float(number)) == number;
        if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
            ints = ints && std::in_range<std::int64_t>(value);
            unsignedInts = unsignedInts && std::in_range<std::uint64_t>(value);
            const double error = errorOfDouble(value, number);
            floats = floats && error == 0;
            doubleError = std::max(doubleError, error);
        } else {
            ints = ints && whole && number >= -0x1p63 && number < 0x1p63;
            unsignedInts = unsignedInts && whole && number >= 0 && number < 0x1p64;
        }
    }
    void append(const ValueFacts& other);
    /// Whether `type` holds every value.
    bool fit(RawType type) const;

  private:
    template <typename T>
    static double errorOfDouble(T value, double number) {
        // From 2^53 on doubles are whole numbers; the largest may round to 2^64, which is 0 then.
        const std::uint64_t whole = number < 0        ? -std::uint64_t(-number)
                                    : number < 0x1p64 ? std::uint64_t(number)
                                                      : 0;
        const std::uint64_t difference = whole - std::uint64_t(value);
        return double(std::min(difference, -difference));
    }
};

/// Returns the facts of all values of a volume, those of its inactive voxels included. The result
/// does not depend on the number of threads.
ValueFacts factsOf(const Volume& volume);

}  // namespace deltasplat
