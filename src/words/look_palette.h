// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "volume/value_census.h"

namespace deltasplat {

/// Numbers keys as they occur. Thread-safe; only the numbers depend on timing, not the count.
class LookPalette {
  public:
    /// @param most  number of numbers, at most 65535
    explicit LookPalette(std::size_t most);

    /// Returns the number of a key, 1 to `most`; 0 if there are too many keys.
    /// @param key  not 0
    std::uint32_t numberOf(std::uint64_t key);
    /// Limits the numbers to a share of `most` from now on. Not while others ask.
    void limitTo(double share);
    bool isLimited() const { return limit_ < most_; }
    std::size_t most() const { return most_; }
    std::size_t count() const { return count_; }
    bool hasTooMany() const { return hasTooMany_.load(std::memory_order_relaxed); }
    /// Returns the keys in the order of their numbers. Not while others ask.
    std::vector<std::uint64_t> keys() const;

  private:
    struct Place {
        std::atomic<std::uint64_t> key = 0;
        std::atomic<std::uint32_t> number = 0;  // set soon after `key`
    };

    std::size_t most_;
    std::size_t limit_;
    std::vector<Place> places_;  // open hash table, at most half full
    std::atomic<std::uint32_t> count_ = 0;
    std::atomic<bool> hasTooMany_ = false;
};

/// A thread's recent queries of a palette, because most keys recur soon.
class LookCache {
  public:
    LookCache() : entries_(kEntries) {}

    std::uint32_t numberOf(std::uint64_t key, LookPalette& palette) {
        Entry& entry = entries_[hashPlace(key, kEntries)];
        if (entry.key != key) entry = {key, palette.numberOf(key)};
        return entry.number;
    }

  private:
    struct Entry {
        std::uint64_t key = 0;
        std::uint32_t number = 0;
    };
    static constexpr std::size_t kEntries = std::size_t{1} << 13;

    std::vector<Entry> entries_;
};

}  // namespace deltasplat
