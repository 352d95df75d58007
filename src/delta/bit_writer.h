// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ingest/delta/bit_reader.h"

namespace deltasplat {

/// Writes what BitReader reads.
class BitWriter {
  public:
    /// @param bits  0..64; those of `number` above have to be 0
    void put(std::uint64_t number, int bits) {
        if (bits == 0) return;
        if (used_ == 64) {
            words_.push_back(0);
            used_ = 0;
        }
        words_.back() |= number << used_;
        const int left = 64 - used_;
        if (bits > left) words_.push_back(number >> left);
        used_ = bits > left ? bits - left : used_ + bits;
    }

    /// @param number  below 2^64 - 1
    void putNumber(std::uint64_t number) {
        const int zeros = int(std::bit_width(number + 1)) - 1;
        put(0, zeros);
        put(1, 1);
        put((number + 1) & BitReader::lowBits(zeros), zeros);
    }

    std::size_t bits() const { return 64 * words_.size() - std::size_t(64 - used_); }

    /// Returns what has been written, up to a whole word.
    const std::vector<std::uint64_t>& words() const { return words_; }

  private:
    std::vector<std::uint64_t> words_;
    int used_ = 64;  // bits of the last word
};

}  // namespace deltasplat
