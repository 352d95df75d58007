// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace deltasplat {

/// Calls use(i) for the tiles with bytes other than zero, which are rare in most rows of tiles.
/// @param tiles  a byte per tile, and zeros up to a multiple of eight
template <typename Use>
inline void forTiles(std::span<const std::uint8_t> tiles, const Use& use) {
    for (std::size_t first = 0; first < tiles.size(); first += 8) {
        std::uint64_t word;
        std::memcpy(&word, &tiles[first], sizeof word);
        if (word == 0) continue;
        for (std::size_t i = first; i < first + 8; ++i) {
            if (tiles[i] != 0) use(i);
        }
    }
}

/// Returns rows of a tile, at least one, and the rows between them.
inline unsigned withRowsBetween(unsigned rows) {
    return 0xFFu << std::countr_zero(rows) & ((1u << std::bit_width(rows)) - 1);
}

}  // namespace deltasplat
