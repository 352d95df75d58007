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

struct RawScan {
    ValueCensus census;                ///< of the finite values
    FrequentValues frequent;           ///< of the finite values
    std::uint64_t nonFinite = 0;       ///< NaN and infinities
    std::uint64_t firstNonFinite = 0;  ///< index in the run; meaningless if nonFinite is 0

    /// Adds the run that follows this one.
    void append(const RawScan& next);
};

/// Scans `count` values on all threads, with the same result for any number of threads.
RawScan scanRawValues(const std::byte* bytes, std::size_t count, RawType type, bool bigEndian,
                      bool distinct);

struct RawCoding {
    RawType type = RawType::kUint8;
    bool bigEndian = false;
    const CodeBook& book;
    const BookEncoder& encoder;   ///< of `book`
    double nanValue = 0;          ///< replaces NaN and infinities
    ErrorMeter* meter = nullptr;  ///< null: codes are exact
};

/// A box of at most 8x8x8 voxels in memory, x contiguous.
struct RawBlock {
    const std::byte* first = nullptr;
    std::size_t rowBytes = 0;    ///< from one y to the next
    std::size_t sliceBytes = 0;  ///< from one z to the next
    glm::ivec3 size{8};
};

/// Writes a block's codes into `codes` [512] at x * 64 + y * 8 + z, OpenVDB's order in a leaf.
/// Entries outside of the block stay unchanged.
using EncodeBlock = void (*)(const RawBlock& block, const RawCoding& coding, Code* codes);

/// Returns the function for the coding's type, byte order and kind of book.
EncodeBlock blockEncoder(const RawCoding& coding);

/// Counts, multi-threaded, the values equal to each of `values`; NaN and infinities are `nanValue`.
std::vector<std::uint64_t> countEqual(const std::byte* bytes, std::size_t count,
                                      const RawCoding& coding, const std::vector<double>& values);

/// Writes a block's values as `T`, in the order of codes; NaN and infinities as `nanValue`, if set.
/// Instantiated for float, double, std::int32_t, std::int64_t, from any raw type that T holds.
template <typename T>
void readValues(const RawBlock& block, RawType type, bool bigEndian, std::optional<T> nanValue,
                T* values);

}  // namespace deltasplat
