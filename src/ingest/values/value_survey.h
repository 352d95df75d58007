// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltasplat {

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
