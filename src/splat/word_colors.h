// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory_resource>

#include "delta/packed_deltas.h"
#include "deltasplat/optics/class_table.h"
#include "splat/digit_voxels.h"
#include "uncleared_array.h"

namespace deltasplat {

/// What the voxels of words are seen as that have looks of their own: in digits, and premultiplied
/// by the opacity that their class has in a step.
class WordColors {
  public:
    /// Looks at every word. Multi-threaded.
    /// @param memory   for colours
    /// @throw Error(kFailed) if there is not enough memory
    WordColors(const PackedDeltas& deltas, const LookLight& light,
               std::pmr::memory_resource& memory);

    /// Which planes and digits there are, and in which units; of classes there is the empty one.
    const ClassTable& table() const { return table_; }
    /// Which voxels have which digits; null where there is but one digit.
    const DigitVoxels* digitVoxels() const { return table_.oneDigit() ? nullptr : &digitVoxels_; }
    /// Returns the colours, `[64]`, of the voxels of a word; of those that are not visible 0.
    const ClassTable::Color* of(DigitPlace digit, std::size_t word) const {
        return digits_[numberOf(digit)][word].data();
    }

  private:
    using Colors = std::array<ClassTable::Color, 64>;
    static std::size_t numberOf(DigitPlace digit) {
        return 2 * std::size_t(digit.plane) + (digit.low ? 1 : 0);
    }
    std::uint64_t voxelsOf(DigitPlace digit, std::size_t word) const;

    ClassTable table_;
    std::array<UnclearedArray<Colors>, 2 * ClassTable::kMaxPlanes> digits_;  // [digit][word]
    DigitVoxels digitVoxels_;
};

}  // namespace deltasplat
