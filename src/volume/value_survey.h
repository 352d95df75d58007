// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

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

/// Values that lie close together: all 0, or of one sign and within an eighth of an octave.
struct ValueCell {
    double low = 0;   ///< the smallest value
    double high = 0;  ///< the largest value
    std::uint64_t count = 0;
};

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

}  // namespace deltasplat
