// SPDX-License-Identifier: Apache-2.0
#include "volume/value_survey.h"

#include <algorithm>

namespace deltasplat {

void ValueSurvey::open(std::size_t key, double value) {
    cells_.push_back({value, value, 0});
    keys_.push_back(std::uint16_t(key));
    cellOfKey_[key] = std::uint16_t(cells_.size());
}

void ValueSurvey::append(const ValueSurvey& other) {
    if (cellOfKey_.empty()) cellOfKey_.assign(kKeys, 0);
    for (std::size_t i = 0; i < other.cells_.size(); ++i) {
        const ValueCell& more = other.cells_[i];
        const std::size_t key = other.keys_[i];
        if (cellOfKey_[key] == 0) open(key, more.low);
        ValueCell& cell = cells_[cellOfKey_[key] - std::size_t{1}];
        cell.low = std::min(cell.low, more.low);
        cell.high = std::max(cell.high, more.high);
        cell.count += more.count;
    }
}

std::vector<ValueCell> ValueSurvey::cells() const {
    std::vector<ValueCell> sorted = cells_;
    std::sort(sorted.begin(), sorted.end(),
              [](const ValueCell& a, const ValueCell& b) { return a.low < b.low; });
    return sorted;
}

}  // namespace deltasplat
