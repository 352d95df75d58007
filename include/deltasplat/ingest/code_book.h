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

/// Maps codes to data values and back. Values never decrease as the code grows; two
/// codes may have equal values: the half zeros, and all codes of a linear book with step 0.
struct CodeBook {
    enum class Kind {
        kInteger,  ///< value = offset + code: exact for integers that span at most 65536 values
        kHalf,     ///< order-preserving IEEE binary16 pattern: exact for every finite half float
        kLinear,   ///< value = offset + step * code: error at most step / 2 inside the range
        kTable,    ///< value = table[code]: exact for at most 65536 different values, otherwise
                   ///< error at most relativeError * |source value|
        kPieces  ///< ladders, one behind the other, each with a step of its own: error at most half
                 ///< of it
    };
    /// A ladder of a book of pieces: first, first + step, ... Its codes follow those of the one
    /// before.
    struct Piece {
        double first = 0;
        double step = 0;  ///< values of the source are within half of it of a rung
        int count = 1;    ///< rungs
    };
    Kind kind = Kind::kInteger;
    double offset = 0;
    double step = 1;
    /// kTable, kPieces: [1..65536] increasing finite values, -0 before 0. Codes beyond stand for
    /// the last.
    std::shared_ptr<const std::vector<double>> table;
    /// kTable: how far source values may be from the code's, as a share of their magnitude.
    double relativeError = 0;
    /// kPieces: what the table is made of.
    std::shared_ptr<const std::vector<Piece>> pieces = nullptr;

    /// Returns the data value that `code` stands for (NaN for the half patterns of NaN).
    double valueOf(Code code) const;
    /// Returns the code whose value is nearest to `value`, clamped to the book's range.
    Code codeOf(double value) const;
    /// Returns how far source values that were given the code may be from its value: half a step
    /// of a linear book or a piece, a share of the value of a table with relative errors, otherwise
    /// 0.
    double largestErrorOf(Code code) const;
    /// Returns whether voxels of this value get the code.
    bool standsFor(Code code, double value) const;
    /// Returns "integer", "half", "linear", "table" or "pieces".
    std::string name() const;
    /// Whether a source that was given this book by a reader comes back from it bit for bit.
    bool isExact() const {
        return kind != Kind::kLinear && kind != Kind::kPieces && relativeError == 0;
    }

    static CodeBook integer(std::int64_t offset = 0);
    static CodeBook half();
    /// What the values of a source are.
    enum class Values { kWhole, kFloat, kDouble };
    /// Spreads 2^bits codes over [low, high], such that the values of codes are of the source's
    /// kind, so that they lose nothing when they come back as such. The step is a whole number, or
    /// has up to 8 significant bits (where values are not much finer than the kind tells apart it
    /// is up to twice as wide as need be, otherwise up to 1/128) and the offset is a multiple of
    /// it: so 0, if it lies within, is the value of a code. A book with low == high has the one
    /// value `low`.
    static CodeBook linear(double low, double high, int bits = 16, Values values = Values::kDouble);
    /// @param values  [1..65536] increasing, finite
    static CodeBook ofTable(std::vector<double> values);
    /// @param pieces  of 1..65536 rungs together, all finite, each above the one before
    static CodeBook ofPieces(std::vector<Piece> pieces);

    /// The values that a book of relative errors has to stand for.
    struct Range {
        double low = 0, high = 0;
        double least = 0;  ///< the smallest magnitude other than 0
        Values values = Values::kDouble;
    };
    /// Returns a table of the range's kind of values, 0 among them, of which each value in the
    /// range is within `error` (0..1, exclusive) times its own magnitude; empty if that takes more
    /// than 65536 codes.
    static std::optional<CodeBook> relative(const Range& range, double error);
};

}  // namespace deltasplat
