// SPDX-License-Identifier: Apache-2.0
#include "volume/distinct_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deltasplat {

void DistinctValues::insert(std::uint64_t bits) {
    last_ = bits;
    if (tooMany_) return;
    if (bits == kNone) {
        hasNone_ = true;
        return;
    }
    if (2 * (count_ + 1) > places_.size()) grow();
    place(bits);
    if (count_ > std::size_t(kCodeCount)) giveUp();
}

void DistinctValues::place(std::uint64_t bits) {
    std::size_t at = hashPlace(bits, places_.size());
    while (places_[at] != kNone && places_[at] != bits) at = (at + 1) & (places_.size() - 1);
    count_ += places_[at] == kNone ? 1 : 0;
    places_[at] = bits;
}

void DistinctValues::grow() {
    std::vector<std::uint64_t> old(std::max<std::size_t>(256, 4 * places_.size()), kNone);
    std::swap(old, places_);
    count_ = 0;
    for (const std::uint64_t bits : old) {
        if (bits != kNone) place(bits);
    }
}

void DistinctValues::giveUp() {
    tooMany_ = true;
    hasNone_ = false;
    count_ = 0;
    places_ = {};
}

void DistinctValues::append(const DistinctValues& other) {
    if (other.tooMany_) giveUp();
    if (other.hasNone_ && !tooMany_) hasNone_ = true;
    for (const std::uint64_t bits : other.places_) {
        if (bits != kNone && !tooMany_) insert(bits);
    }
}

std::vector<double> DistinctValues::sorted() const {
    std::vector<double> values;
    for (const std::uint64_t bits : places_) {
        if (bits != kNone) values.push_back(std::bit_cast<double>(bits));
    }
    if (hasNone_) values.push_back(std::bit_cast<double>(kNone));
    std::sort(values.begin(), values.end(), [](double a, double b) {
        if (std::isnan(a) || std::isnan(b)) {
            const bool both = std::isnan(a) && std::isnan(b);
            return both ? std::bit_cast<std::uint64_t>(a) < std::bit_cast<std::uint64_t>(b)
                        : std::isnan(b);
        }
        return a != b ? a < b : std::signbit(a) && !std::signbit(b);
    });
    return values;
}

}  // namespace deltasplat
