// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "deltasplat/ingest/code_book.h"
#include "formats/raw/raw_format.h"
#include "volume/book_encoder.h"
#include "volume/value_census.h"

namespace deltasplat {

/// What a run of raw values holds.
struct RawScan {
    ValueCensus census;                ///< of the finite values
    FrequentValues frequent;           ///< of the finite values
    std::uint64_t nonFinite = 0;       ///< NaN and infinities
    std::uint64_t firstNonFinite = 0;  ///< position in the run; meaningless if there is none

    /// Adds the run that follows this one.
    void append(const RawScan& next);
};

/// Scans `count` values on all threads; the result does not depend on their number.
/// @param distinct  whether to collect different values
RawScan scanRawValues(const std::byte* bytes, std::size_t count, RawType type, bool bigEndian,
                      bool distinct);

/// How raw values become codes.
struct RawCoding {
    RawType type = RawType::kUint8;
    bool bigEndian = false;
    const CodeBook& book;
    const BookEncoder& encoder;   ///< of `book`
    double nanValue = 0;          ///< what NaN and infinities count as
    ErrorMeter* meter = nullptr;  ///< null: codes are exact
};

/// A box of at most 8x8x8 voxels in memory, x contiguous.
struct RawBlock {
    const std::byte* first = nullptr;
    std::size_t rowBytes = 0;    ///< from one y to the next
    std::size_t sliceBytes = 0;  ///< from one z to the next
    glm::ivec3 size{8};
};

/// Writes a block's codes into `codes` [512] at x * 64 + y * 8 + z, OpenVDB's order in a leaf;
/// places outside of the block keep what they held.
using EncodeBlock = void (*)(const RawBlock& block, const RawCoding& coding, Code* codes);

/// Returns the function for this coding's type, byte order and kind of book.
EncodeBlock blockEncoder(const RawCoding& coding);

/// Counts on all threads how many of `count` values equal each of `values`; NaN and infinities
/// count as `nanValue`.
std::vector<std::uint64_t> countEqual(const std::byte* bytes, std::size_t count,
                                      const RawCoding& coding, const std::vector<double>& values);

/// Writes a block's values in the order of codes, as `T`; NaN and infinities as `nanValue`, if
/// there is one. Instantiated for float, double, std::int32_t and std::int64_t, from any raw type
/// that T holds.
template <typename T>
void readValues(const RawBlock& block, RawType type, bool bigEndian, std::optional<T> nanValue,
                T* values);

}  // namespace deltasplat
