// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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
        kLinear,   ///< value = offset + step * code: error at most step / 2 inside the range
        kTable     ///< value = table[code]: exact for at most 65536 different values
    };
    Kind kind = Kind::kInteger;
    double offset = 0;
    double step = 1;
    /// kTable: [1..65536] increasing finite values, -0 before 0. Codes beyond stand for the last.
    std::shared_ptr<const std::vector<double>> table;

    /// Returns the data value that `code` stands for (NaN for the half patterns of NaN).
    double valueOf(Code code) const;
    /// Returns the code whose value is nearest to `value`, clamped to the book's range.
    Code codeOf(double value) const;
    /// Returns whether voxels of this value get the code: within half a step of a linear book,
    /// exactly otherwise.
    bool standsFor(Code code, double value) const;
    /// Returns "integer", "half", "linear" or "table".
    std::string name() const;
    /// Whether a source that was given this book by a reader comes back from it bit for bit.
    bool isExact() const { return kind != Kind::kLinear; }

    static CodeBook integer(std::int64_t offset = 0);
    static CodeBook half();
    /// Spreads 2^bits codes over [low, high], so that 0 within is the value of a code (then the
    /// ends may lie beyond by a step); a book with low == high has the one value `low`.
    static CodeBook linear(double low, double high, int bits = 16);
    /// @param values  [1..65536] increasing, finite
    static CodeBook ofTable(std::vector<double> values);
};

}  // namespace deltasplat
