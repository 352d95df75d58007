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

/// Returns where to begin looking for `bits` in an open hash table of `size` places, a power of two
/// from 2 on.
inline std::size_t hashPlace(std::uint64_t bits, std::size_t size) {
    constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio (D. Knuth)
    // Doubles that are whole numbers have zeros at the end, which multiplication keeps.
    return std::size_t((bits ^ (bits >> 32)) * kSpread >> (65 - std::bit_width(size)));
}

/// The different values among many, as long as there are at most kCodeCount of them: told
/// apart by their bits, so that -0 is not 0.
class DistinctValues {
  public:
    void add(double value) {
        // Neighbours are often equal.
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (bits != last_) insert(bits);
    }
    void append(const DistinctValues& other);
    /// There are more than kCodeCount.
    bool tooMany() const { return tooMany_; }
    /// Stops collecting, as if there were too many.
    void giveUp();
    /// Returns the values in increasing order, -0 before 0, NaN last by their bits. Meaningless if
    /// there are too many.
    std::vector<double> sorted() const;

  private:
    static constexpr std::uint64_t kNone = 0x7ff8000000000000;  // stands for an empty place
    void insert(std::uint64_t bits);
    void place(std::uint64_t bits);
    void grow();

    std::vector<std::uint64_t> places_;  // an open hash table, at most half full
    std::size_t count_ = 0;
    std::optional<std::uint64_t> last_;
    bool hasNone_ = false;  // kNone is among the values: the usual NaN
    bool tooMany_ = false;
};

/// Finds every value that more than a ninth of many values have, in one pass over them.
class FrequentValues {
  public:
    void add(double value, std::uint64_t count = 1) {
        // Neighbours are often equal, and most places are taken by what is frequent.
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

    /// Returns what was found, and may be more: with counts that are at most the true ones.
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

/// Values that lie close together: all 0, or of one sign and within an eighth of an octave.
struct ValueCell {
    double low = 0;   ///< the smallest value
    double high = 0;  ///< the largest value
    std::uint64_t count = 0;
};

/// How exactly a fitted book is to keep values: each within kRelativeNeed of its magnitude, and
/// values of the bulk within kBulkNeed of its width as well.
inline constexpr double kRelativeNeed = 2e-4;
inline constexpr double kBulkNeed = 0x1p-16;

/// Returns the bulk of the values: from the cell of their 1st to that of their 99th percentile,
/// those that are 0 and the frequent ones left out. Outliers do not move it.
/// @param frequent  with counts that are at most the true ones
glm::dvec2 bulkOf(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent);

/// Fits a book to where values lie: codes go only there. All is asked of every value, but for those
/// next to 0, whose share of themselves is next to nothing; they are allowed an error that is as
/// small as 65536 codes allow. If codes are left over, all errors are made smaller alike; if they
/// do not suffice, some needs are given up, one after the other and each only as far as it takes:
///   1. the hundredth of the values that is nearest to 0 is off by more than kRelativeNeed;
///   2. the bulk is kept no better than other values;
///   3. the tenth of the values that is nearest to 0 is off by more than a thousandth of itself;
///   4. every value is off by up to a thousandth of itself;
///   5. values are off by kBulkNeed of the bulk's width;
///   6. every value is off by a larger share.
/// @param cells     at least one
/// @param frequent  values that are to have a code to themselves; those outside of all cells none
/// @param kind      what the values of codes are to be
CodeBook fitBook(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent,
                 CodeBook::Values kind);

// What numbers of a kind there are.

/// Returns the largest number.
inline double largestOf(CodeBook::Values kind) {
    return kind == CodeBook::Values::kFloat ? double(std::numeric_limits<float>::max())
                                            : std::numeric_limits<double>::max();
}

/// Returns the distance from `large` > 0 to the number below it.
inline double spacingBelow(double large, CodeBook::Values kind) {
    const double doubles = large - std::nextafter(large, 0.0);
    if (kind == CodeBook::Values::kWhole) return std::max(doubles, 1.0);
    if (kind == CodeBook::Values::kDouble) return doubles;
    return double(float(large)) - double(std::nextafter(float(large), 0.0f));
}

/// Returns the number above `value`.
inline double nextAbove(double value, CodeBook::Values kind) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (kind == CodeBook::Values::kWhole)
        return std::max(std::floor(value) + 1, std::nextafter(value, kInfinity));
    if (kind == CodeBook::Values::kDouble) return std::nextafter(value, kInfinity);
    return double(std::nextafter(float(value), std::numeric_limits<float>::infinity()));
}

/// Returns the number below `value`.
inline double nextBelow(double value, CodeBook::Values kind) {
    return -nextAbove(-value, kind);
}

/// Returns a number next to `value`.
inline double nearestOf(double value, CodeBook::Values kind) {
    if (kind == CodeBook::Values::kWhole) return std::nearbyint(value);
    return kind == CodeBook::Values::kFloat ? double(float(value)) : value;
}

/// Returns the largest step of at most `width`, and at least of the spacing of numbers, whose
/// multiples up to `large` are numbers: it has as few significant bits as that takes, at most 7.
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

/// Counts where finite values lie.
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
    /// Returns the cells in increasing order.
    std::vector<ValueCell> cells() const;

  private:
    /// Sign, exponent and the three highest bits of what follows; 0 is not among denormals.
    static constexpr int kShift = 49;
    static constexpr std::size_t kKeys = (std::size_t{1} << (64 - kShift)) + 1;
    static std::size_t keyOf(double value) {
        return value == 0 ? kKeys - 1 : std::bit_cast<std::uint64_t>(value) >> kShift;
    }
    void open(std::size_t key, double value);

    std::vector<std::uint16_t> cellOfKey_;  // [kKeys]: place in cells_ + 1; 0: none
    std::vector<ValueCell> cells_;
    std::vector<std::uint16_t> keys_;  // of cells_
};

/// What finite values have in common: all that the choice of a code book depends on.
struct ValueCensus {
    double min = 0;
    double max = 0;
    double least = 0;  ///< the smallest magnitude other than 0; 0 if there is none
    std::uint64_t count = 0;
    bool half = true;     ///< every value is a binary16 number
    bool whole = true;    ///< every value is a whole number, and none is -0
    bool exact = true;    ///< a double holds every value
    bool floats = true;   ///< a float holds every value
    bool ints = true;     ///< an int64 holds every value, of integers of 64 bits
    double rounding = 0;  ///< largest difference between an integer and its nearest double
    DistinctValues distinct;
    ValueSurvey survey;  ///< unless it was skipped
    bool skipSurvey = false;
    /// Values that have, or may have, many voxels: a book gives them codes of their own.
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
    /// Adds finite values, as add() does each of them. Returns false, and adds none, if one is not
    /// finite; integers are.
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
    /// Adds a value that was added before, so many times more.
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
        // Binary16 has 10 of the 52 bits behind the point, and most numbers have more.
        if ((std::bit_cast<std::uint64_t>(number) & ((std::uint64_t{1} << 42) - 1)) != 0)
            return false;
        const double magnitude = std::fabs(number);
        if (magnitude >= 0x1p-14 && magnitude <= 65504) return true;
        return double(float(openvdb::math::half(float(number)))) == number;
    }
    static double off(std::uint64_t value) {
        const auto number = double(value);
        // The largest round to 2^64.
        const std::uint64_t back = number < 0x1p64 ? std::uint64_t(number) : 0;
        return double(std::min(back - value, value - back));
    }
};

/// Returns the magnitude of which kBulkNeed of the bulk's width is the share kRelativeNeed.
double bulkMagnitude(const ValueCensus& census);

/// Returns the code book of values that are all halves, or whole and close together, as chooseBook
/// does; these need no survey, nor their different values. Empty: there is no such book.
/// @param real  the source's type is real
std::optional<CodeBook> plainBook(const ValueCensus& census, bool real);

/// Returns the code book for values of this census: exact if there is one. Real values that are
/// all halves get `half`; whole numbers that span at most 65536 get `integer`; at most 65536
/// different ones `table`; others what fitBook makes of them: `pieces`, or `linear` where one
/// ladder is as good.
/// @param real     the source's type is real; whole numbers never get `half`
/// @param reading  its `bits` asks for `linear` instead of an exact book, for real types; its
///                 `relativeError` for a `table` of relative errors instead of what would not be
///                 exact, where 65536 codes are enough for that
/// @param where    file, for messages
/// @throw Error(kInput) if the values lie too far apart
CodeBook chooseBook(const ValueCensus& census, bool real, const ReadOptions& reading,
                    const std::string& where);

}  // namespace deltasplat
