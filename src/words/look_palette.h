// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "volume/value_census.h"

namespace deltasplat {

/// Numbers keys as they come up. Any number of threads may ask at once: which key gets which number
/// is left to chance, but not whether there are too many.
class LookPalette {
  public:
    /// @param most  that there are numbers for, 65535 at most
    explicit LookPalette(std::size_t most);

    /// Returns the number of a key, 1 to `most`; 0 if there are too many.
    /// @param key  not 0
    std::uint32_t numberOf(std::uint64_t key);
    /// From now on takes more than a share of `most` for too many. Not while others ask.
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
        std::atomic<std::uint32_t> number = 0;  // of a key: soon
    };

    std::size_t most_;
    std::size_t limit_;
    std::vector<Place> places_;  // an open hash table, half full at most
    std::atomic<std::uint32_t> count_ = 0;
    std::atomic<bool> hasTooMany_ = false;
};

/// What one thread has asked a palette for: most keys come up again soon.
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
