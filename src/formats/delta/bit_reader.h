// SPDX-License-Identifier: Apache-2.0
// Based on: Robert Rice, "Some Practical Universal Noiseless Coding Techniques", 1979. Here a
// quotient has a limit, behind which a number stands as it is.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace deltasplat {

/// Reads numbers of any width from words of 64 bits, each from its lowest bit on. What is read
/// behind the last word has to be there: whoever reads damaged words asks `position` often enough.
class BitReader {
  public:
    /// @param position  of the first bit to be read
    BitReader(const std::uint64_t* words, std::size_t position)
        : words_(words), position_(position) {}

    /// How many bits lie between the first word and what is read next.
    std::size_t position() const { return position_; }
    void skip(int bits) { position_ += std::size_t(bits); }

    /// Returns the next 64 bits; the first is the lowest.
    std::uint64_t peek() const {
        const std::uint64_t* const word = words_ + (position_ >> 6);
        const int shift = int(position_ & 63);
        // Two shifts, since one by 64 is undefined.
        return word[0] >> shift | word[1] << 1 << (63 - shift);
    }

    /// @param bits  0..64
    std::uint64_t take(int bits) {
        const std::uint64_t taken = peek() & lowBits(bits);
        skip(bits);
        return taken;
    }

    /// Takes a number of any size: Elias's gamma code of it and 1. The largest of all stands for
    /// what no such code is.
    std::uint64_t takeNumber() {
        const int zeros = std::countr_zero(peek());
        if (zeros == 64) return std::numeric_limits<std::uint64_t>::max();
        skip(zeros + 1);
        return (std::uint64_t{1} << zeros | take(zeros)) - 1;
    }

    void skipToWord() { position_ = (position_ + 63) / 64 * 64; }

    /// Returns a mask of the `count` lowest bits, 0..64.
    static std::uint64_t lowBits(int count) {
        return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    }

  private:
    const std::uint64_t* words_;
    std::size_t position_;
};

/// How numbers of one kind are written: as a quotient in ones, a zero, and a remainder of as many
/// bits as the parameter says; or, where there would be kMostOnes ones, as those and all its bits.
/// Their bits lie in planes (plane_kernels.h).
struct RiceCode {
    static constexpr int kMostOnes = 8;

    int width = 32;  ///< bits of the largest number

    /// Bits of a parameter.
    int parameterBits() const { return width > 32 ? 6 : 5; }
};

}  // namespace deltasplat
