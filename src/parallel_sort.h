// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "parallel.h"

namespace deltasplat {

/// Sorts as std::sort does, on all threads.
/// @param isBefore  which of two items comes first; where it says of neither, either may
template <typename T, typename IsBefore>
void parallelSort(std::vector<T>& items, const IsBefore& isBefore) {
    // Of fewer items, pieces are sorted before a thread begins.
    constexpr std::size_t kLeast = 4096;
    constexpr std::size_t kMostPieces = 64;
    const std::size_t pieces =
        std::bit_floor(std::clamp<std::size_t>(items.size() / kLeast, 1, kMostPieces));
    const auto edge = [&](std::size_t i) {
        return items.begin() + std::ptrdiff_t(i * items.size() / pieces);
    };
    parallelFor(pieces, [&](std::size_t i) { std::sort(edge(i), edge(i + 1), isBefore); });
    for (std::size_t width = 1; width < pieces; width *= 2) {
        parallelFor(pieces / (2 * width), [&](std::size_t i) {
            const std::size_t first = 2 * width * i;
            std::inplace_merge(edge(first), edge(first + width), edge(first + 2 * width), isBefore);
        });
    }
}

}  // namespace deltasplat
