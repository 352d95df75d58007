// SPDX-License-Identifier: Apache-2.0
// Based on: Robert Rice, "Some Practical Universal Noiseless Coding Techniques", 1979. Here a
// quotient has a limit, behind which a number stands as it is.
#pragma once

#include <bit>
#include <cstdint>

#include "ingest/delta/bit_reader.h"

namespace deltasplat {

/// How numbers of one kind are written: as a quotient in ones, a zero, and a remainder of as many
/// bits as the parameter says; or, where there would be kMostOnes ones, as those and all its bits.
/// Their bits may lie in planes (plane_kernels.h).
struct RiceCode {
    static constexpr int kMostOnes = 8;

    int width = 32;  ///< bits of the largest number

    /// Bits of a parameter.
    int parameterBits() const { return width > 32 ? 6 : 5; }

    /// Takes one that lies by itself.
    std::uint64_t take(BitReader& in, int parameter) const {
        // All of most numbers lies in the 64 bits that are looked at.
        constexpr int kLongest = 64 - kMostOnes;
        const std::uint64_t bits = in.peek();
        const int ones = std::countr_one(bits);
        if (ones >= kMostOnes) {
            in.skip(kMostOnes);
            return in.take(width);
        }
        in.skip(ones + 1);
        const std::uint64_t quotient = std::uint64_t(ones) << parameter;
        if (parameter > kLongest) return quotient | in.take(parameter);
        in.skip(parameter);
        return quotient | (bits >> (ones + 1) & BitReader::lowBits(parameter));
    }
};

}  // namespace deltasplat
