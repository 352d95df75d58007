// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// A digit of colours on a plane (ClassTable).
struct DigitPlace {
    int plane = 0;
    bool low = false;

    const ClassTable::Digit& of(const ClassTable& classes) const {
        const ClassTable::Plane& all = classes.planes[std::size_t(plane)];
        return low ? all.low : all.high;
    }
};

/// Which voxels of slices have which digits, where colours have more than one.
class DigitVoxels {
  public:
    /// Looks at every word, once for each digit. Multi-threaded.
    /// @param withLow  whether it is asked which voxels have a low digit
    /// @throw Error(kFailed) if there is not enough memory
    DigitVoxels(const PackedDeltas& deltas, const ClassTable& classes, bool withLow);

    /// Returns mask words as DeltaWord has them, one for each of the deltas' words: of the low
    /// digit, voxels that have it; of the high one, those that have anything on the plane. Null if
    /// that is all that are visible, or is not asked.
    const std::uint64_t* of(DigitPlace digit) const {
        const auto& voxels = voxels_[std::size_t(digit.plane)][digit.low ? 1 : 0];
        return voxels.empty() ? nullptr : voxels.data();
    }

    /// Whether words that have any voxels of the digit have fewer than so many, on average.
    bool fewerThan(std::uint64_t voxels, DigitPlace digit) const;

  private:
    std::array<std::array<std::vector<std::uint64_t>, 2>, ClassTable::kMaxPlanes> voxels_;
};

}  // namespace deltasplat
