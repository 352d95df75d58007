// SPDX-License-Identifier: Apache-2.0
// Based on: J. Misra, D. Gries, "Finding repeated elements", 1982; merging after P. Agarwal et al.,
// "Mergeable summaries", 2012.
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/source_values.h"
#include "volume/float_kernels.h"

namespace deltasplat {

/// Returns where to look first in an open hash table of `size` places, a power of two from 2 on.
inline std::size_t hashPlace(std::uint64_t bits, std::size_t size) {
    constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio (D. Knuth)
    // Doubles that are whole end in zero bits, and multiplication would keep these zeros.
    return std::size_t((bits ^ (bits >> 32)) * kSpread >> (65 - std::bit_width(size)));
}

/// Collects the different values among many, up to kCodeCount. Compares bits, so -0 differs from 0.
class DistinctValues {
  public:
    void add(double value) {
        // Neighbours are often equal.
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (bits != last_) insert(bits);
    }
    void append(const DistinctValues& other);
    /// Whether there are more than kCodeCount values, or giveUp() was called.
    bool tooMany() const { return tooMany_; }
    void giveUp();
    /// Returns increasing values, -0 before 0, NaN last by bits. Meaningless if there are too many.
    std::vector<double> sorted() const;

  private:
    static constexpr std::uint64_t kNone = 0x7ff8000000000000;  // marks an empty place
    void insert(std::uint64_t bits);
    void place(std::uint64_t bits);
    void grow();

    std::vector<std::uint64_t> places_;  // open hash table, at most half full
    std::size_t count_ = 0;
    std::optional<std::uint64_t> last_;
    bool hasNone_ = false;  // kNone, the usual NaN, is among the values
    bool tooMany_ = false;
};

/// Finds every value that makes up more than a ninth of all values, in one pass.
class FrequentValues {
  public:
    void add(double value, std::uint64_t count = 1) {
        // Neighbours are often equal, and most places hold frequent values.
        for (std::size_t i = 0; i < kPlaces; ++i) {
            if (places_[i].count > 0 && places_[i].value == value) {
                places_[i].count += count;
                return;
            }
        }
        take({value, count});
    }

    void append(const FrequentValues& other) {
        std::vector<FrequentValue> all = values();
        for (const FrequentValue& one : other.values()) {
            const auto same = std::find_if(all.begin(), all.end(), [&](const FrequentValue& place) {
                return place.value == one.value;
            });
            same != all.end() ? void(same->count += one.count) : all.push_back(one);
        }
        const auto fewer = [](const FrequentValue& a, const FrequentValue& b) {
            return a.count != b.count ? a.count > b.count : a.value < b.value;
        };
        std::sort(all.begin(), all.end(), fewer);
        const std::uint64_t lost = all.size() > kPlaces ? all[kPlaces].count : 0;
        places_ = {};
        for (std::size_t i = 0; i < std::min(kPlaces, all.size()); ++i)
            places_[i] = {all[i].value, all[i].count - lost};
    }

    /// Returns all frequent values, and maybe others. Counts are at most the true ones.
    std::vector<FrequentValue> values() const {
        std::vector<FrequentValue> found;
        for (const FrequentValue& place : places_) {
            if (place.count > 0) found.push_back(place);
        }
        return found;
    }

  private:
    static constexpr std::size_t kPlaces = 8;

    void take(const FrequentValue& one) {
        for (FrequentValue& place : places_) {
            if (place.count > 0) continue;
            place = one;
            return;
        }
        std::uint64_t least = one.count;
        for (const FrequentValue& place : places_) least = std::min(least, place.count);
        for (FrequentValue& place : places_) place.count -= least;
        if (one.count > least) take({one.value, one.count - least});
    }

    std::array<FrequentValue, kPlaces> places_{};
};

/// A range of close values: all 0, or of one sign and within an eighth of an octave.
struct ValueCell {
    double low = 0;
    double high = 0;
    std::uint64_t count = 0;
};

/// Goal of a fitted book: values within kRelativeNeed of themselves, the bulk's also within
/// kBulkNeed of its width.
inline constexpr double kRelativeNeed = 2e-4;
inline constexpr double kBulkNeed = 0x1p-16;

/// Returns the bulk of the values: from the cell of the 1st percentile to that of the 99th. Ignores
/// 0 and the frequent values; outliers do not move the bulk.
/// @param frequent  counts are at most the true ones
glm::dvec2 bulkOf(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent);

/// Fits a book to the distribution of values, without codes where there are no values. Every value
/// meets both needs, except values so close to 0 that a share of them is next to nothing: their
/// error is as small as 65536 codes allow. Spare codes make all errors smaller by the same factor.
/// If codes are too few, needs are given up in this order, each only as far as necessary:
///   1. the hundredth of the values nearest to 0 is off by more than kRelativeNeed;
///   2. the bulk is no more accurate than other values;
///   3. the tenth of the values nearest to 0 is off by more than a thousandth of itself;
///   4. every value is off by up to a thousandth of itself;
///   5. values are off by kBulkNeed of the bulk's width;
///   6. every value is off by a larger share.
/// @param cells     at least one
/// @param frequent  values that get a code of their own; values outside of all cells get none
/// @param kind      of the values that codes stand for
CodeBook fitBook(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent,
                 CodeBook::Values kind);

// Arithmetic of the numbers of one kind.

inline double largestOf(CodeBook::Values kind) {
    return kind == CodeBook::Values::kFloat ? double(std::numeric_limits<float>::max())
                                            : std::numeric_limits<double>::max();
}

/// Returns the distance from `large` > 0 to the next smaller number.
inline double spacingBelow(double large, CodeBook::Values kind) {
    const double doubles = large - std::nextafter(large, 0.0);
    if (kind == CodeBook::Values::kWhole) return std::max(doubles, 1.0);
    if (kind == CodeBook::Values::kDouble) return doubles;
    return double(float(large)) - double(std::nextafter(float(large), 0.0f));
}

inline double nextAbove(double value, CodeBook::Values kind) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (kind == CodeBook::Values::kWhole)
        return std::max(std::floor(value) + 1, std::nextafter(value, kInfinity));
    if (kind == CodeBook::Values::kDouble) return std::nextafter(value, kInfinity);
    return double(std::nextafter(float(value), std::numeric_limits<float>::infinity()));
}

inline double nextBelow(double value, CodeBook::Values kind) {
    return -nextAbove(-value, kind);
}

/// Returns the nearest number, or one next to `value`.
inline double nearestOf(double value, CodeBook::Values kind) {
    if (kind == CodeBook::Values::kWhole) return std::nearbyint(value);
    return kind == CodeBook::Values::kFloat ? double(float(value)) : value;
}

/// Returns the largest step that is at most `width`, at least the spacing of numbers, and whose
/// multiples up to `large` are numbers. It has as few significant bits as that needs, at most 7.
inline double stepBelow(double width, double large, CodeBook::Values kind) {
    const double spacing = spacingBelow(large, kind);
    if (!(width > spacing)) return spacing;
    if (kind == CodeBook::Values::kWhole) return std::max(std::floor(width), spacing);
    const int digits = kind == CodeBook::Values::kFloat ? std::numeric_limits<float>::digits
                                                        : std::numeric_limits<double>::digits;
    const int bits = std::clamp(digits - std::ilogb(large / width + 2) - 1, 1, 7);
    int exponent = 0;
    const double mantissa = std::frexp(width, &exponent);
    return std::max(std::ldexp(std::floor(std::ldexp(mantissa, bits)), exponent - bits), spacing);
}

/// Counts the distribution of finite values.
class ValueSurvey {
  public:
    void add(double value, std::uint64_t count = 1) {
        const std::size_t key = keyOf(value);
        if (cellOfKey_.empty()) cellOfKey_.assign(kKeys, 0);
        if (cellOfKey_[key] == 0) open(key, value);
        ValueCell& cell = cells_[cellOfKey_[key] - std::size_t{1}];
        if (value < cell.low) cell.low = value;
        if (value > cell.high) cell.high = value;
        cell.count += count;
    }
    void append(const ValueSurvey& other);
    std::vector<ValueCell> cells() const;

  private:
    /// Key: sign, exponent and three bits of the mantissa. 0 has its own key, apart from denormals.
    static constexpr int kShift = 49;
    static constexpr std::size_t kKeys = (std::size_t{1} << (64 - kShift)) + 1;
    static std::size_t keyOf(double value) {
        return value == 0 ? kKeys - 1 : std::bit_cast<std::uint64_t>(value) >> kShift;
    }
    void open(std::size_t key, double value);

    std::vector<std::uint16_t> cellOfKey_;  // [kKeys]: index into cells_ + 1; 0: none
    std::vector<ValueCell> cells_;
    std::vector<std::uint16_t> keys_;  // [cell]
};

/// Common properties of finite values, sufficient for the choice of a code book.
struct ValueCensus {
    double min = 0;
    double max = 0;
    double least = 0;  ///< smallest magnitude other than 0; 0 if there is none
    std::uint64_t count = 0;
    bool half = true;     ///< every value is a binary16 number
    bool whole = true;    ///< every value is a whole number, and none is -0
    bool exact = true;    ///< a double holds every value
    bool floats = true;   ///< a float holds every value
    bool ints = true;     ///< an int64 holds every value, if the type is a 64-bit integer
    double rounding = 0;  ///< largest difference between an integer and its nearest double
    DistinctValues distinct;
    ValueSurvey survey;  ///< empty if skipSurvey
    bool skipSurvey = false;
    /// Values that have, or may have, many voxels and therefore get codes of their own.
    std::vector<FrequentValue> frequent;

    template <typename T>
    void add(T value) {
        const auto number = double(value);
        min = count == 0 ? number : std::min(min, number);
        max = count == 0 ? number : std::max(max, number);
        ++count;
        const double magnitude = std::fabs(number);
        if (magnitude > 0 && (least == 0 || magnitude < least)) least = magnitude;
        if constexpr (!std::is_same_v<T, float>) floats = floats && double(float(number)) == number;
        if constexpr (std::is_floating_point_v<T>) {
            half = half && isHalf(number);
            whole = whole && number == std::floor(number) && (number != 0 || !std::signbit(number));
        } else {
            constexpr std::int64_t kMost = std::int64_t{1} << 53;
            exact = exact && std::int64_t(value) >= -kMost && std::int64_t(value) <= kMost;
            if constexpr (std::is_same_v<T, std::uint64_t>) {
                ints = ints && std::int64_t(value) >= 0;
                rounding = std::max(rounding, off(value));
            }
        }
        distinct.add(number);
        if (!skipSurvey) survey.add(number);
    }
    /// Adds all values as add() does. If a value is not finite, returns false and adds none.
    template <typename T>
    bool addAll(std::span<const T> values) {
        if constexpr (std::is_same_v<T, float>) {
            if (values.empty()) return true;
            const FloatFacts facts = factsOf(values);
            if (!facts.isFinite) return false;
            if (distinct.tooMany() && skipSurvey) {
                add(facts, values.size());
                return true;
            }
        } else if constexpr (std::is_floating_point_v<T>) {
            for (const T value : values) {
                if (!std::isfinite(value)) return false;
            }
        }
        for (const T value : values) add(value);
        return true;
    }
    /// Adds `times` more of a value that was added before.
    void repeat(double value, std::uint64_t times) {
        count += times;
        if (!skipSurvey) survey.add(value, times);
    }
    void append(const ValueCensus& next);

  private:
    void add(const FloatFacts& facts, std::uint64_t values) {
        min = count == 0 ? double(facts.min) : std::min(min, double(facts.min));
        max = count == 0 ? double(facts.max) : std::max(max, double(facts.max));
        count += values;
        if (facts.least > 0 && (least == 0 || double(facts.least) < least))
            least = double(facts.least);
        half = half && facts.isHalf;
        whole = whole && facts.isWhole;
    }
    static bool isHalf(double number) {
        // A binary16 has 10 of the 52 mantissa bits, and most numbers use more.
        if ((std::bit_cast<std::uint64_t>(number) & ((std::uint64_t{1} << 42) - 1)) != 0)
            return false;
        const double magnitude = std::fabs(number);
        if (magnitude >= 0x1p-14 && magnitude <= 65504) return true;
        return double(float(openvdb::math::half(float(number)))) == number;
    }
    static double off(std::uint64_t value) {
        const auto number = double(value);
        // The largest values round to 2^64.
        const std::uint64_t back = number < 0x1p64 ? std::uint64_t(number) : 0;
        return double(std::min(back - value, value - back));
    }
};

/// Returns the magnitude of which kRelativeNeed equals kBulkNeed of the bulk's width.
double bulkMagnitude(const ValueCensus& census);

/// Returns the book that chooseBook chooses for values that are all halves, or all whole and close
/// together; nothing for other values. Needs no survey and no distinct values.
/// @param real  the source's type is real
std::optional<CodeBook> plainBook(const ValueCensus& census, bool real);

/// Chooses the code book for values of this census, an exact one if possible: real values that are
/// all halves get `half`; whole numbers that span at most 65536, `integer`; at most 65536 different
/// values, `table`; others fitBook's: `pieces`, or `linear` if one ladder is as good.
/// @param real     the source's type is real; whole numbers never get `half`
/// @param reading  `bits` asks for `linear` instead of an exact book, for real types;
///                 `relativeError` for a `table` of relative errors instead of an inexact book, if
///                 65536 codes suffice
/// @param where    file, for messages
/// @throw Error(kInput) if the values lie too far apart
CodeBook chooseBook(const ValueCensus& census, bool real, const ReadOptions& reading,
                    const std::string& where);

}  // namespace deltasplat
