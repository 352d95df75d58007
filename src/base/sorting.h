// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "deltasplat/threads.h"

namespace deltasplat {

/// Sorts as std::sort does, on all threads: samples of the items bound buckets, and each bucket is
/// sorted by one thread.
/// @param isBefore  which of two items comes first; of two equal items either may
template <typename T, typename IsBefore>
void parallelSort(std::vector<T>& items, const IsBefore& isBefore) {
    // Fewer items are sorted before a second thread has started.
    constexpr std::size_t kLeast = 8192;
    constexpr std::size_t kBuckets = 64;
    constexpr std::size_t kSamplesPerBucket = 16;
    constexpr std::size_t kPieces = 64;
    if (items.size() < kLeast || threadCount() == 1)
        return std::sort(items.begin(), items.end(), isBefore);
    std::vector<const T*> samples;
    for (std::size_t i = 0; i < kBuckets * kSamplesPerBucket; ++i)
        samples.push_back(&items[i * (items.size() / (kBuckets * kSamplesPerBucket))]);
    const auto isLess = [&](const T* a, const T* b) { return isBefore(*a, *b); };
    std::sort(samples.begin(), samples.end(), isLess);
    std::vector<const T*> firsts;  // of all buckets but the first one
    for (std::size_t i = 1; i < kBuckets; ++i) firsts.push_back(samples[i * kSamplesPerBucket]);

    using Counts = std::array<std::size_t, kBuckets>;
    const auto edge = [&](std::size_t piece) { return piece * items.size() / kPieces; };
    std::vector<std::uint8_t> buckets(items.size());
    std::vector<Counts> places(kPieces);  // how many items of a bucket; then where they go
    parallelFor(kPieces, [&](std::size_t piece) {
        for (std::size_t i = edge(piece); i < edge(piece + 1); ++i) {
            const auto bucket = std::upper_bound(firsts.begin(), firsts.end(), &items[i], isLess);
            buckets[i] = std::uint8_t(bucket - firsts.begin());
            ++places[piece][buckets[i]];
        }
    });
    Counts ends{};
    std::size_t place = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
        for (Counts& counts : places) place += std::exchange(counts[bucket], place);
        ends[bucket] = place;
    }
    std::vector<T> sorted(items.size());
    parallelFor(kPieces, [&](std::size_t piece) {
        for (std::size_t i = edge(piece); i < edge(piece + 1); ++i)
            sorted[places[piece][buckets[i]]++] = std::move(items[i]);
    });
    parallelFor(kBuckets, [&](std::size_t bucket) {
        const auto begin = sorted.begin() + std::ptrdiff_t(bucket == 0 ? 0 : ends[bucket - 1]);
        std::sort(begin, sorted.begin() + std::ptrdiff_t(ends[bucket]), isBefore);
    });
    items = std::move(sorted);
}

/// Cuts a list into runs of neighbours that belong together, such as the blocks of a column.
/// @param together  together(a, b): whether b, which follows a, belongs to the same run
/// @return where each run begins, and last the number of items
template <typename T, typename Together>
std::vector<std::size_t> runBegins(const std::vector<T>& items, const Together& together) {
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i == 0 || !together(items[i - 1], items[i])) begins.push_back(i);
    }
    begins.push_back(items.size());
    return begins;
}

}  // namespace deltasplat
