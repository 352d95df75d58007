// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "bit_matrix.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Turns what a sheet knows of a row of tiles, a byte for each tile, into a row of bits for each of
/// its eight rows of pixels, 64 tiles a word.
/// @param rows   [kTilePixels][words], zeros
/// @return bit y: whether row y has any
inline unsigned findFullRows(const Sheet& sheet, int tileRow, std::size_t words,
                             std::span<std::uint64_t> rows) {
    const std::span<const std::uint8_t> tiles = sheet.fullRows(tileRow);
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < tiles.size(); i += 8) {
        std::uint64_t bytes;
        std::memcpy(&bytes, &tiles[i], sizeof bytes);
        if (bytes == 0) continue;
        any |= bytes;
        bytes = transposedBits(bytes);
        for (std::size_t y = 0; y < kTilePixels; ++y)
            rows[y * words + i / 64] |= (bytes >> (8 * y) & 0xFF) << (i % 64);
    }
    any |= any >> 32;
    any |= any >> 16;
    return unsigned(any | any >> 8) & 0xFF;
}

/// Returns how many words of 64 tiles a row of a sheet has.
inline std::size_t wordsOfRow(const Sheet& sheet) {
    return (sheet.fullRows(0).size() + 63) / 64;
}

/// Calls emit(first, last) for every run of set bits [first, last) in a row of words.
template <typename Emit>
void forEachRun(std::span<const std::uint64_t> words, const Emit& emit) {
    int open = -1;  // where a run began that reaches up to the word in hand
    for (std::size_t i = 0; i < words.size(); ++i) {
        const int base = int(64 * i);
        std::uint64_t word = words[i];
        int bit = 0;
        while (bit < 64) {
            const std::uint64_t rest = (open < 0 ? word : ~word) >> bit;
            if (rest == 0) break;
            bit += std::countr_zero(rest);
            if (open < 0) {
                open = base + bit;
            } else {
                emit(open, base + bit);
                open = -1;
            }
        }
    }
    if (open >= 0) emit(open, int(64 * words.size()));
}

}  // namespace deltasplat
