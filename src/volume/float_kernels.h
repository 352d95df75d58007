// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Facts about floats, as in ValueCensus. All functions here return the same at every SIMD level.
struct FloatFacts {
    bool isFinite = true;  ///< if false, the other members mean nothing
    bool isHalf = true;
    bool isWhole = true;
    float min = 0;
    float max = 0;
    float least = 0;  ///< smallest magnitude other than 0; 0 if there is none
};

/// @param values  at least one
FloatFacts factsOf(std::span<const float> values);

/// Writes the codes of values that are all halves, in the book of halves.
void codesOfHalves(std::span<const float> values, Code* codes);

/// Writes the codes of whole values in a book of whole numbers from `offset` on, all within 2^24.
void codesOfWhole(std::span<const float> values, float offset, Code* codes);

/// Writes the codes of binary16 patterns in the book of halves. Returns whether all are finite.
bool codesOfHalfBits(std::span<const std::uint16_t> bits, Code* codes);

}  // namespace deltasplat
