// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/read_volume.h"
#include "volume/distinct_values.h"
#include "volume/fitted_book.h"
#include "volume/float_kernels.h"
#include "volume/value_survey.h"

namespace deltasplat {

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
