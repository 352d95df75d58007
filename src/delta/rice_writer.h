// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "delta/bit_writer.h"
#include "ingest/delta/rice_code.h"

namespace deltasplat {

/// A parameter for some numbers, and how many bits they take with it.
struct RiceChoice {
    int parameter = 0;
    std::uint64_t bits = std::numeric_limits<std::uint64_t>::max();
};

/// Returns the parameter with which numbers take the fewest bits, the smallest such.
template <typename Number>
RiceChoice bestRice(RiceCode code, std::span<const Number> numbers) {
    Number all = 0;
    for (const Number number : numbers) all |= number;
    RiceChoice best;
    for (int parameter = 0; parameter < code.width; ++parameter) {
        std::uint64_t bits = 0;
        for (const Number number : numbers) {
            const Number quotient = number >> parameter;
            bits += quotient < RiceCode::kMostOnes ? std::uint64_t(quotient) + 1 + parameter
                                                   : RiceCode::kMostOnes + code.width;
        }
        if (bits < best.bits) best = {parameter, bits};
        // A larger one gives every number another bit.
        if ((all >> parameter) == 0) break;
    }
    return best;
}

/// Writes a number for RiceCode::take.
inline void putRice(BitWriter& out, RiceCode code, int parameter, std::uint64_t number) {
    const std::uint64_t quotient = number >> parameter;
    if (quotient >= RiceCode::kMostOnes) {
        out.put(BitReader::lowBits(RiceCode::kMostOnes), RiceCode::kMostOnes);
        out.put(number, code.width);
    } else {
        out.put(BitReader::lowBits(int(quotient)), int(quotient) + 1);
        out.put(number & BitReader::lowBits(parameter), parameter);
    }
}

}  // namespace deltasplat
