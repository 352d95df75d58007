// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// A voxel's stored integer, 0..65535.
using Code = std::uint16_t;
inline constexpr int kCodeCount = 65536;

/// Maps codes to data values and back. Values never decrease as the code grows. Two codes may have
/// equal values: the half zeros, and all codes of a linear book with step 0.
struct CodeBook {
    enum class Kind {
        kInteger,  ///< value = offset + code: exact for integers that span at most 65536 values
        kHalf,     ///< order-preserving IEEE binary16 pattern: exact for every finite half float
        kLinear,   ///< value = offset + step * code: error at most step / 2 inside the range
        kTable,    ///< value = table[code]: exact for at most 65536 different values, otherwise
                   ///< error at most relativeError * |source value|
        kPieces  ///< ladders, one behind the other, each with its own step: error at most step / 2
    };
    /// A ladder in a book of pieces: first, first + step, ... Codes follow the previous ladder's.
    struct Piece {
        double first = 0;
        double step = 0;  ///< source values are within step / 2 of a rung
        int count = 1;    ///< rungs
    };
    Kind kind = Kind::kInteger;
    double offset = 0;
    double step = 1;
    /// kTable, kPieces: [1..65536] increasing finite values, -0 before 0. Larger codes: the last.
    std::shared_ptr<const std::vector<double>> table;
    /// kTable: largest error of the code's value, as a share of the source value's magnitude.
    double relativeError = 0;
    /// kPieces: the ladders of the table.
    std::shared_ptr<const std::vector<Piece>> pieces = nullptr;

    /// Returns the data value of `code` (NaN for the half patterns of NaN).
    double valueOf(Code code) const;
    /// Returns the code whose value is nearest to `value`, clamped to the book's range.
    Code codeOf(double value) const;
    /// Returns the largest error of source values with this code: half a step of a linear book or a
    /// piece, a share of the value in a table with relative errors, otherwise 0.
    double largestErrorOf(Code code) const;
    bool standsFor(Code code, double value) const;
    std::string name() const;
    /// Whether a source that a reader gave this book comes back from it bit for bit.
    bool isExact() const {
        return kind != Kind::kLinear && kind != Kind::kPieces && relativeError == 0;
    }

    static CodeBook integer(std::int64_t offset = 0);
    static CodeBook half();
    /// The kind of a source's values.
    enum class Values { kWhole, kFloat, kDouble };
    /// Spreads 2^bits codes over [low, high], with values of the source's kind, which lose nothing
    /// when they come back as such. The step is a whole number, or has up to 8 significant bits: up
    /// to 1/128 wider than necessary, or twice as wide for values not much finer than the kind
    /// resolves. The offset is a multiple of the step, so 0 in the range is the value of a code.
    /// With low == high the book has the one value `low`.
    static CodeBook linear(double low, double high, int bits = 16, Values values = Values::kDouble);
    /// @param values  [1..65536] increasing, finite
    static CodeBook ofTable(std::vector<double> values);
    /// @param pieces  of 1..65536 finite rungs together, each above the one before
    static CodeBook ofPieces(std::vector<Piece> pieces);

    /// Values for a book of relative errors.
    struct Range {
        double low = 0, high = 0;
        double least = 0;  ///< smallest magnitude other than 0
        Values values = Values::kDouble;
    };
    /// Returns a table, with 0, of the range's kind of values that has a value within `error`
    /// (0..1, exclusive) times the magnitude of every value in the range; empty beyond 65536 codes.
    static std::optional<CodeBook> relative(const Range& range, double error);
};

}  // namespace deltasplat
