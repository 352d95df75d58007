// SPDX-License-Identifier: Apache-2.0
// Based on: J. Misra, D. Gries, "Finding repeated elements", 1982; merging after P. Agarwal et al.,
// "Mergeable summaries", 2012.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "deltasplat/ingest/source_values.h"

namespace deltasplat {

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
