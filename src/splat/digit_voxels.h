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

/// Which voxels of slices have which digits, for colours of several digits.
class DigitVoxels {
  public:
    /// Looks at every word once per digit. Multi-threaded.
    /// @param withLow  whether voxels with low digits are needed
    /// @throw Error(kFailed) if there is not enough memory
    DigitVoxels(const PackedDeltas& deltas, const ClassTable& classes, bool withLow);

    /// Returns a mask word, as in DeltaWord, per word of the deltas: voxels with the low digit, or,
    /// for the high digit, with anything on the plane. Null: all visible voxels, or not needed.
    const std::uint64_t* of(DigitPlace digit) const {
        const auto& voxels = voxels_[std::size_t(digit.plane)][digit.low ? 1 : 0];
        return voxels.empty() ? nullptr : voxels.data();
    }

    /// Whether words with voxels of the digit have fewer than `voxels` of them on average.
    bool fewerThan(std::uint64_t voxels, DigitPlace digit) const;

  private:
    std::array<std::array<std::vector<std::uint64_t>, 2>, ClassTable::kMaxPlanes> voxels_;
};

}  // namespace deltasplat
