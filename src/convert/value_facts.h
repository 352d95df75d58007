// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "deltasplat/ingest/volume.h"
#include "ingest/raw/raw_format.h"

namespace deltasplat {

/// What the finite values of a volume have in common: which types hold all of them.
struct ValueFacts {
    double min = 0;
    double max = 0;
    bool any = false;
    bool whole = true;       ///< whole numbers, none of them -0
    bool floats = true;      ///< a float holds every value
    double doubleError = 0;  ///< largest difference between a value and its nearest double

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
        if constexpr (std::is_same_v<T, std::int64_t>) {
            const double error = errorOfDouble(value, number);
            floats = floats && error == 0;
            doubleError = std::max(doubleError, error);
        }
    }
    void append(const ValueFacts& other);
    /// Whether `type` holds every value.
    bool fit(RawType type) const;

  private:
    static double errorOfDouble(std::int64_t value, double number) {
        // Between 2^53 and 2^63, where doubles are whole numbers; the largest may round to 2^63.
        const auto whole = number < 0 ? -std::uint64_t(-number) : std::uint64_t(number);
        const std::uint64_t difference = whole - std::uint64_t(value);
        return double(std::min(difference, -difference));
    }
};

/// Returns the facts of all values of a volume, those of its inactive voxels included. The result
/// does not depend on the number of threads.
ValueFacts factsOf(const Volume& volume);

}  // namespace deltasplat
