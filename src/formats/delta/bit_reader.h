// SPDX-License-Identifier: Apache-2.0
// Based on: Robert Rice, "Some Practical Universal Noiseless Coding Techniques", 1979. Here
// quotients have a limit, behind which a number stands uncoded.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace deltasplat {

/// Reads numbers of any width from 64-bit words, lowest bits first. The words need padding: readers
/// of damaged words run past the end until they check `position`.
class BitReader {
  public:
    BitReader(const std::uint64_t* words, std::size_t position)
        : words_(words), position_(position) {}

    /// Returns the index of the next bit.
    std::size_t position() const { return position_; }
    void skip(int bits) { position_ += std::size_t(bits); }

    /// Returns the next 64 bits; the first is the lowest.
    std::uint64_t peek() const {
        const std::uint64_t* const word = words_ + (position_ >> 6);
        const int shift = int(position_ & 63);
        // Two shifts, because a shift by 64 is undefined.
        return word[0] >> shift | word[1] << 1 << (63 - shift);
    }

    /// @param bits  0..64
    std::uint64_t take(int bits) {
        const std::uint64_t taken = peek() & lowBits(bits);
        skip(bits);
        return taken;
    }

    /// Takes Elias's gamma code of a number plus 1. Returns the largest number for an invalid code.
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

/// Rice code of one kind of numbers: a quotient in ones, a zero, and a remainder of `parameter`
/// bits. kMostOnes ones instead precede all bits of a number. Bits lie in planes (plane_kernels.h).
struct RiceCode {
    static constexpr int kMostOnes = 8;

    int width = 32;  ///< bits of the largest number

    int parameterBits() const { return width > 32 ? 6 : 5; }
};

/// Writes words for BitReader.
class BitWriter {
  public:
    /// @param bits  0..64; higher bits of `number` must be 0
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

    /// Returns all words, the last one padded with zeros.
    const std::vector<std::uint64_t>& words() const { return words_; }

  private:
    std::vector<std::uint64_t> words_;
    int used_ = 64;  // bits of the last word
};

/// A parameter for some numbers, and the bits that they take with it.
struct RiceChoice {
    int parameter = 0;
    std::uint64_t bits = std::numeric_limits<std::uint64_t>::max();
};

/// Returns the smallest parameter with which numbers take the fewest bits.
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
        // Larger parameters add a bit to every number.
        if ((all >> parameter) == 0) break;
    }
    return best;
}

/// Writes at most 64 numbers for takePlanes.
template <typename Number>
void putPlanes(BitWriter& out, RiceCode code, int parameter, std::span<const Number> numbers) {
    const auto putPlane = [&](const auto& hasBit, const auto& bitOf) {
        std::uint64_t plane = 0;
        int bits = 0;
        for (const Number number : numbers)
            if (hasBit(number)) plane |= std::uint64_t{bitOf(number)} << bits++;
        out.put(plane, bits);
    };
    const auto quotientOf = [&](Number number) { return std::uint64_t(number) >> parameter; };
    for (std::uint64_t level = 0; level < RiceCode::kMostOnes; ++level) {
        putPlane([&](Number number) { return quotientOf(number) >= level; },
                 [&](Number number) { return quotientOf(number) > level; });
    }
    for (int bit = 0; bit < parameter; ++bit) {
        putPlane([](Number) { return true; },
                 [&](Number number) { return (number >> bit & 1) != 0; });
    }
    for (const Number number : numbers) {
        if (quotientOf(number) >= RiceCode::kMostOnes)
            out.put(quotientOf(number), code.width - parameter);
    }
}

}  // namespace deltasplat
