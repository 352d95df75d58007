// SPDX-License-Identifier: Apache-2.0
#include "ingest/distinct_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ingest/hash_place.h"

namespace deltasplat {

void DistinctValues::insert(std::uint64_t bits) {
    last_ = bits;
    if (tooMany_) return;
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
    count_ = 0;
    places_ = {};
}

void DistinctValues::append(const DistinctValues& other) {
    if (other.tooMany_) giveUp();
    for (const std::uint64_t bits : other.places_) {
        if (bits != kNone && !tooMany_) insert(bits);
    }
}

std::vector<double> DistinctValues::sorted() const {
    std::vector<double> values;
    for (const std::uint64_t bits : places_) {
        if (bits != kNone) values.push_back(std::bit_cast<double>(bits));
    }
    std::sort(values.begin(), values.end(), [](double a, double b) {
        return a != b ? a < b : std::signbit(a) && !std::signbit(b);
    });
    return values;
}

}  // namespace deltasplat
