// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// The different values among many, as long as there are at most kCodeCount of them: told
/// apart by their bits, so that -0 is not 0.
class DistinctValues {
  public:
    void add(double value) {
        // Neighbours are often equal.
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (bits != last_) insert(bits);
    }
    void append(const DistinctValues& other);
    /// There are more than kCodeCount.
    bool tooMany() const { return tooMany_; }
    /// Stops collecting, as if there were too many.
    void giveUp();
    /// Returns the values in increasing order, -0 before 0, NaN last by their bits. Meaningless if
    /// there are too many.
    std::vector<double> sorted() const;

  private:
    static constexpr std::uint64_t kNone = 0x7ff8000000000000;  // stands for an empty place
    void insert(std::uint64_t bits);
    void place(std::uint64_t bits);
    void grow();

    std::vector<std::uint64_t> places_;  // an open hash table, at most half full
    std::size_t count_ = 0;
    std::optional<std::uint64_t> last_;
    bool hasNone_ = false;  // kNone is among the values: the usual NaN
    bool tooMany_ = false;
};

}  // namespace deltasplat
