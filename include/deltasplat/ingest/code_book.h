// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace deltasplat {

/// A voxel's stored integer, 0..65535.
using Code = std::uint16_t;
inline constexpr int kCodeCount = 65536;

/// Maps codes to data values and back. Values never decrease as the code grows; two
/// codes may have equal values: the half zeros, and all codes of a linear book with step 0.
struct CodeBook {
    enum class Kind {
        kInteger,  ///< value = offset + code: exact for integers that span at most 65536 values
        kHalf,     ///< order-preserving IEEE binary16 pattern: exact for every finite half float
        kLinear    ///< value = offset + step * code: error at most step / 2 inside the range
    };
    Kind kind = Kind::kInteger;
    double offset = 0;
    double step = 1;

    /// Returns the data value that `code` stands for (NaN for the half patterns of NaN).
    double valueOf(Code code) const;
    /// Returns the code whose value is nearest to `value`, clamped to the book's range.
    Code codeOf(double value) const;
    /// Returns whether voxels of this value get the code: within half a step of a linear book,
    /// exactly otherwise.
    bool standsFor(Code code, double value) const;
    /// Returns "integer", "half" or "linear".
    std::string name() const;

    static CodeBook integer(std::int64_t offset = 0);
    static CodeBook half();
    /// Spreads all 65536 codes over [low, high]; a book with low == high has the one value `low`.
    static CodeBook linear(double low, double high);
};

}  // namespace deltasplat
