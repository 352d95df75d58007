// SPDX-License-Identifier: Apache-2.0
// Based on: Robert Rice, "Some Practical Universal Noiseless Coding Techniques", 1979. Here a
// quotient has a limit, behind which a number stands as it is.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "ingest/delta/bit_reader.h"
#include "ingest/delta/rice_steps.h"

namespace deltasplat {

/// How numbers of one kind are written: as a quotient in ones, a zero, and a remainder of as many
/// bits as the parameter says; or, where there would be kMostOnes ones, as those and all its bits.
struct RiceCode {
    static constexpr int kMostOnes = 8;

    int width = 32;  ///< bits of the largest number

    /// Bits of a parameter.
    int parameterBits() const { return width > 32 ? 6 : 5; }

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

    /// Takes numbers that stand one behind the other.
    template <typename Number>
    void takeSome(BitReader& in, int parameter, std::size_t count, Number* numbers) const {
        Number* const end = numbers + count;
        if (const RiceStep* const steps = riceSteps(parameter))
            numbers = takeSteps(in, parameter, steps, numbers, end);
        // As many as 64 bits are sure to hold are taken of them, if they have quotients.
        const int longest = kMostOnes + parameter;
        const std::uint64_t remainder = BitReader::lowBits(parameter);
        while (numbers != end) {
            std::uint64_t bits = in.peek();
            int left = 64;
            int ones = 0;
            while (numbers != end && left >= longest) {
                ones = std::countr_one(bits);
                if (ones >= kMostOnes) break;
                // Two shifts, as a parameter may be 63.
                bits = bits >> ones >> 1;
                *numbers++ = Number(std::uint64_t(ones) << parameter | (bits & remainder));
                bits >>= parameter;
                left -= ones + 1 + parameter;
            }
            in.skip(64 - left);
            if (numbers != end && (ones >= kMostOnes || left == 64))
                *numbers++ = Number(take(in, parameter));
        }
    }

  private:
    // Takes most of them, several at a time. Returns where the others go.
    template <typename Number>
    Number* takeSteps(BitReader& in, int parameter, const RiceStep* steps, Number* numbers,
                      Number* end) const {
        constexpr std::uint64_t kMask = (std::uint64_t{1} << RiceStep::kLookedAt) - 1;
        while (end - numbers >= RiceStep::kMostNumbers) {
            std::uint64_t bits = in.peek();
            int left = 64;
            bool isLong = false;
            while (!isLong && left >= RiceStep::kLookedAt &&
                   end - numbers >= RiceStep::kMostNumbers) {
                const RiceStep& step = steps[bits & kMask];
                // All are written, lest how many there are has to be guessed.
                for (std::size_t i = 0; i < RiceStep::kMostNumbers; ++i)
                    numbers[i] = step.numbers[i];
                numbers += step.count;
                bits >>= step.bits;
                left -= step.bits;
                isLong = step.count == 0;
            }
            in.skip(64 - left);
            if (isLong) *numbers++ = Number(take(in, parameter));
        }
        return numbers;
    }
};

}  // namespace deltasplat
