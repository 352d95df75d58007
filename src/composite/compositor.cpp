// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, the base plane.
#include "composite/compositor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <span>

#include "bit_matrix.h"

namespace deltasplat {
namespace {

// Calls emit(first, last) for every run of set bits [first, last) in a row of words.
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

}  // namespace

void Compositor::composite(const Sheet& sheet, const SheetShift& shift, int firstRow, int lastRow,
                           Layer& layer) {
    const OverWeights weights(glm::vec2(shift.fraction), scale_, layer.channels, frontToBack_);
    findSpans(sheet, shift, firstRow, lastRow, weights.straight(), layer);
    overSpans(spans_, weights);
}

// Finds the runs of pixels that the sheet reaches.
void Compositor::findSpans(const Sheet& sheet, const SheetShift& shift, int firstRow, int lastRow,
                           bool straight, Layer& layer) {
    words_ = (sheet.fullRows(0).size() + 63) / 64;
    rows_.assign((kTilePixels + 1) * words_, 0);
    either_.resize(words_);
    spans_.clear();
    // Rows of the sheet.
    const int begin = std::max(firstRow + shift.offset.y, 0);
    const int end = std::min(lastRow + shift.offset.y, sheet.layout().sizePixels.y - 1);
    // The row before reads into the first one as well. Bit 0: that of the tile row before.
    unsigned rows = 0;
    for (int tileRow = begin / kTilePixels; kTilePixels * tileRow <= end; ++tileRow) {
        rows = rows >> kTilePixels | findRows(sheet, tileRow) << 1;
        const int first = kTilePixels * tileRow - 1;
        for (unsigned rest = (straight ? rows : rows | rows >> 1) & 0xFF; rest != 0;
             rest &= rest - 1) {
            const int y = std::countr_zero(rest);
            if (first + y >= begin && first + y < end)
                addSpans(sheet, shift, first + y, std::size_t(y), straight, layer);
        }
        std::copy_n(&rows_[kTilePixels * words_], words_, rows_.begin());
    }
}

// Turns bytes of eight rows into words of 64 tiles. Returns which rows have any.
unsigned Compositor::findRows(const Sheet& sheet, int tileRow) {
    const std::span<const std::uint8_t> tiles = sheet.fullRows(tileRow);
    std::fill(rows_.begin() + std::ptrdiff_t(words_), rows_.end(), 0);
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < tiles.size(); i += 8) {
        std::uint64_t bytes;
        std::memcpy(&bytes, &tiles[i], sizeof bytes);
        if (bytes == 0) continue;
        any |= bytes;
        bytes = transposedBits(bytes);
        for (std::size_t y = 0; y < kTilePixels; ++y) {
            rows_[(y + 1) * words_ + i / 64] |= (bytes >> (8 * y) & 0xFF) << (i % 64);
        }
    }
    any |= any >> 32;
    any |= any >> 16;
    return unsigned(any | any >> 8) & 0xFF;
}

// Adds what row y of the sheet reaches: `row` of rows_ says where it is full, the next one where
// the row behind it is. Read straight, it reaches no more than itself.
void Compositor::addSpans(const Sheet& sheet, const SheetShift& shift, int y, std::size_t row,
                          bool straight, Layer& layer) {
    for (std::size_t i = 0; i < words_; ++i) {
        either_[i] = rows_[row * words_ + i];
        if (!straight) either_[i] |= rows_[(row + 1) * words_ + i];
    }
    const int channels = sheet.layout().channels;
    const std::int32_t* pixels = sheet.row(y);
    const std::int32_t* nextPixels = sheet.row(y + 1);
    const int layerRow = y - shift.offset.y;
    std::optional<int> begin;
    int end = 0;
    forEachRun(either_, [&](int firstTile, int lastTile) {
        // The pixel before the first one reads into it as well.
        const int first = kTilePixels * firstTile - (straight ? 0 : 1);
        end = kTilePixels * lastTile;
        if (!begin) begin = first;
        spans_.push_back({pixels + channels * first, nextPixels + channels * first,
                          layer.pixel({first - shift.offset.x, layerRow}),
                          std::size_t(end - first)});
    });
    if (begin) layer.extend(layerRow, *begin - shift.offset.x, end - shift.offset.x);
}

}  // namespace deltasplat
