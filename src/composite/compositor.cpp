// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, the base plane.
#include "composite/compositor.h"

#include <algorithm>
#include <bit>
#include <cstring>
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

void Compositor::composite(const Sheet& sheet, const SheetShift& shift, Layer& layer) {
    const OverWeights weights(glm::vec2(shift.fraction), scale_, layer.channels, frontToBack_);
    findSpans(sheet, shift, weights.straight(), layer);
    overSpans(spans_, weights);
}

// Finds the runs of pixels that the sheet reaches.
void Compositor::findSpans(const Sheet& sheet, const SheetShift& shift, bool straight,
                           Layer& layer) {
    words_ = (sheet.fullRows(0).size() + 63) / 64;
    rows_.assign((kTilePixels + 1) * words_, 0);
    either_.resize(words_);
    spans_.clear();
    bool anyBefore = false;
    for (int tileRow = 0; tileRow < sheet.layout().tiles().y; ++tileRow) {
        const bool any = findRows(sheet, tileRow);
        // The row before reads into the first one as well.
        const int first = kTilePixels * tileRow - 1;
        if (any || anyBefore) {
            for (int y = 0; y < (any ? kTilePixels : 1); ++y)
                addSpans(sheet, shift, first + y, std::size_t(y), straight, layer);
        }
        std::copy_n(&rows_[kTilePixels * words_], words_, rows_.begin());
        anyBefore = any;
    }
}

// Turns bytes of eight rows into words of 64 tiles.
bool Compositor::findRows(const Sheet& sheet, int tileRow) {
    const std::span<const std::uint8_t> tiles = sheet.fullRows(tileRow);
    std::fill(rows_.begin() + std::ptrdiff_t(words_), rows_.end(), 0);
    bool any = false;
    for (std::size_t i = 0; i < tiles.size(); i += 8) {
        std::uint64_t bytes;
        std::memcpy(&bytes, &tiles[i], sizeof bytes);
        if (bytes == 0) continue;
        any = true;
        bytes = transposedBits(bytes);
        for (std::size_t y = 0; y < kTilePixels; ++y) {
            rows_[(y + 1) * words_ + i / 64] |= (bytes >> (8 * y) & 0xFF) << (i % 64);
        }
    }
    return any;
}

// Adds what row y of the sheet reaches: `row` of rows_ says where it is full, the next one where
// the row behind it is. Read straight, it reaches no more than itself.
void Compositor::addSpans(const Sheet& sheet, const SheetShift& shift, int y, std::size_t row,
                          bool straight, Layer& layer) {
    const int layerRow = y - shift.offset.y;
    if (layerRow < layer.box.min.y || layerRow >= layer.box.max.y) return;
    std::uint64_t any = 0;
    for (std::size_t i = 0; i < words_; ++i) {
        either_[i] = rows_[row * words_ + i];
        if (!straight) either_[i] |= rows_[(row + 1) * words_ + i];
        any |= either_[i];
    }
    if (any == 0) return;
    const int channels = sheet.layout().channels;
    forEachRun(either_, [&](int firstTile, int lastTile) {
        // The pixel before the first one reads into it as well.
        const int first = kTilePixels * firstTile - (straight ? 0 : 1);
        const int last = kTilePixels * lastTile;
        const glm::ivec2 b = glm::ivec2(first, y) - shift.offset;
        layer.extend(b.y, b.x, b.x + last - first);
        spans_.push_back({sheet.row(y) + channels * first, sheet.row(y + 1) + channels * first,
                          layer.pixel(b), std::size_t(last - first)});
    });
}

}  // namespace deltasplat
