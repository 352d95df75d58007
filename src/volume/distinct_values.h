// SPDX-License-Identifier: Apache-2.0
// Based on: J. Misra, D. Gries, "Finding repeated elements", 1982; merging after P. Agarwal et al.,
// "Mergeable summaries", 2012.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/source_values.h"

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

}  // namespace deltasplat
