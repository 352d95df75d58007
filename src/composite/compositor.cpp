// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, the base plane.
#include "composite/compositor.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>

namespace deltasplat {

std::size_t Compositor::composite(Sheets sheets, const SheetReading& shift, int firstRow,
                                  int lastRow, const SheetCover* cover, Layer& layer) {
    const OverWeights weights(glm::vec2(shift.fraction), scales_, layer.channels);
    findSpans(sheets, shift, firstRow, lastRow, weights.straight, cover, layer);
    OverSheets pixels{{}, sheets.front()->pitch()};
    for (std::size_t p = 0; p < sheets.size(); ++p) pixels.pixels[p] = sheets[p]->row(0);
    overSpans(spans_, pixels, weights);
    std::size_t count = 0;
    for (const OverSpan& span : spans_) count += span.pixels;
    return count;
}

// Finds the runs of pixels that the sheets reach.
void Compositor::findSpans(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                           bool straight, const SheetCover* cover, Layer& layer) {
    const Sheet& sheet = *sheets.front();
    words_ = wordsOfRow(sheet);
    rows_.resize(sheets.size());
    for (Rows& rows : rows_) rows.assign((kTilePixels + 1) * words_, 0);
    either_.resize(sheets.size() + 1);
    for (Rows& row : either_) row.resize(words_);
    spans_.clear();
    // Rows of the sheet.
    const int begin = std::max(firstRow + shift.offset.y, 0);
    const int end = std::min(lastRow + shift.offset.y, sheet.layout().sizePixels.y - 1);
    // The row before reads into the first one as well. Bit 0: that of the tile row before.
    unsigned rows = 0;
    for (int tileRow = begin / kTilePixels; kTilePixels * tileRow <= end; ++tileRow) {
        rows >>= kTilePixels;
        for (std::size_t p = 0; p < sheets.size(); ++p) {
            const std::span ofTiles = std::span(rows_[p]).subspan(words_);
            std::fill(ofTiles.begin(), ofTiles.end(), 0);
            rows |= findFullRows(*sheets[p], tileRow, words_, ofTiles) << 1;
            if (cover) cover->clearHidden(tileRow, words_, ofTiles);
        }
        const int first = kTilePixels * tileRow - 1;
        for (unsigned rest = (straight ? rows : rows | rows >> 1) & 0xFF; rest != 0;
             rest &= rest - 1) {
            const int y = std::countr_zero(rest);
            if (first + y >= begin && first + y < end)
                addSpans(sheet, shift, first + y, std::size_t(y), straight, layer);
        }
        for (Rows& ofPlane : rows_)
            std::copy_n(&ofPlane[kTilePixels * words_], words_, ofPlane.begin());
    }
}

// Adds what row y of the sheets reaches: `row` of rows_ says where they are full, the next one
// where the row behind it is. Read straight, it reaches no more than itself.
void Compositor::addSpans(const Sheet& sheet, const SheetReading& shift, int y, std::size_t row,
                          bool straight, Layer& layer) {
    for (std::size_t p = 0; p < rows_.size(); ++p) {
        const std::uint64_t* here = &rows_[p][row * words_];
        for (std::size_t i = 0; i < words_; ++i)
            either_[p][i] = straight ? here[i] : here[i] | here[i + words_];
    }
    const bool onePlane = rows_.size() == 1;
    Rows& all = either_[onePlane ? 0 : rows_.size()];
    for (std::size_t i = 0; !onePlane && i < words_; ++i) {
        all[i] = 0;
        for (std::size_t p = 0; p < rows_.size(); ++p) all[i] |= either_[p][i];
    }
    const int channels = sheet.layout().channels;
    const std::size_t firstOfRow = std::size_t(y) * sheet.pitch();
    const int layerRow = y - shift.offset.y;
    std::optional<int> begin;
    int end = 0;
    forEachRun(all, [&](int firstTile, int lastTile) {
        // The pixel before the first one reads into it as well.
        const int first = kTilePixels * firstTile - (straight ? 0 : 1);
        end = kTilePixels * lastTile;
        if (!begin) begin = first;
        const OverSpan span{firstOfRow + std::size_t(channels * first),
                            layer.pixel({first - shift.offset.x, layerRow}),
                            std::uint32_t(end - first), 1};
        if (onePlane) {
            spans_.push_back(span);
        } else {
            addRun(firstTile, lastTile, straight, span, channels);
        }
    });
    if (begin) layer.extend(layerRow, *begin - shift.offset.x, end - shift.offset.x);
}

// Cuts a span where other planes are full.
void Compositor::addRun(int firstTile, int lastTile, bool straight, OverSpan span, int channels) {
    const int firstPixel = kTilePixels * lastTile - int(span.pixels);
    int begin = firstPixel;
    std::uint32_t planes = planesAt(firstTile);
    const auto emit = [&](int end, std::uint32_t ofSpan) {
        const int first = begin - firstPixel;
        if (end > begin)
            spans_.push_back({span.place + std::size_t(channels * first),
                              span.layer + channels * first, std::uint32_t(end - begin), ofSpan});
        begin = end;
    };
    for (int tile = firstTile + 1; tile < lastTile; ++tile) {
        const std::uint32_t next = planesAt(tile);
        if (next == planes) continue;
        // The last pixel before a tile reads into it as well: it takes the planes of both.
        const int edge = kTilePixels * tile;
        if (!straight) {
            const std::uint32_t both = planes | next;
            emit(planes == both ? edge : edge - 1, planes);
            if (next != both) emit(edge, both);
        } else {
            emit(edge, planes);
        }
        planes = next;
    }
    emit(kTilePixels * lastTile, planes);
}

// Returns the planes that are full in a tile of the row in hand.
std::uint32_t Compositor::planesAt(int tile) const {
    std::uint32_t planes = 0;
    for (std::size_t p = 0; p < rows_.size(); ++p)
        planes |= std::uint32_t(either_[p][std::size_t(tile) / 64] >> tile % 64 & 1) << p;
    return planes;
}

}  // namespace deltasplat
