// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// What many floats have in common, as ValueCensus has it; the same at every SIMD level, as all of
/// these.
struct FloatFacts {
    bool isFinite = true;  ///< all of them are; otherwise the rest says nothing
    bool isHalf = true;
    bool isWhole = true;
    float min = 0;
    float max = 0;
    float least = 0;  ///< the smallest magnitude other than 0; 0 if there is none
};

/// @param values  at least one
FloatFacts factsOf(std::span<const float> values);

/// Writes the codes of values in the book of halves, whose values they are.
void codesOfHalves(std::span<const float> values, Code* codes);

/// Writes the codes of values in a book of whole numbers from `offset` on, whose values they are;
/// magnitudes are at most 2^24, that of the offset as well.
void codesOfWhole(std::span<const float> values, float offset, Code* codes);

/// Writes the codes of binary16 patterns in the book of halves. Returns whether all are finite.
bool codesOfHalfBits(std::span<const std::uint16_t> bits, Code* codes);

}  // namespace deltasplat
