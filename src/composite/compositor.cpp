// SPDX-License-Identifier: Apache-2.0
// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, the base plane.
#include "composite/compositor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "base/opacity_steps.h"

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

void Compositor::findSpans(Sheets sheets, const SheetReading& shift, int firstRow, int lastRow,
                           bool straight, const SheetCover* cover, Layer& layer) {
    const Sheet& sheet = *sheets.front();
    words_ = wordsOfRow(sheet);
    rows_.resize(sheets.size());
    for (Rows& rows : rows_) rows.assign((kTilePixels + 1) * words_, 0);
    either_.resize(sheets.size() + 1);
    for (Rows& row : either_) row.resize(words_);
    spans_.clear();
    const int begin = std::max(firstRow + shift.offset.y, 0);
    const int end = std::min(lastRow + shift.offset.y, sheet.layout().sizePixels.y - 1);
    // The row before reads into the first row. Bit 0: row of the previous tile row.
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

// Adds spans for row y of the sheets: `row` of rows_ has its full tiles, the next one those of the
// row behind. A straight reading reaches no further row.
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
        // The pixel before a tile reads into it.
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

// Cuts a run where other planes become full.
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
        // The last pixel before a tile reads into it, and takes the planes of both.
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

// Returns the planes that are full in a tile of the current row.
std::uint32_t Compositor::planesAt(int tile) const {
    std::uint32_t planes = 0;
    for (std::size_t p = 0; p < rows_.size(); ++p)
        planes |= std::uint32_t(either_[p][std::size_t(tile) / 64] >> tile % 64 & 1) << p;
    return planes;
}

// Based on: Thomas Porter and Tom Duff, "Compositing Digital Images", 1984, the operator over;
// Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation", 1994, perspective by slices that are scaled.
namespace {

// Longest gap that is composited rather than split.
constexpr int kShortGap = 12;

}  // namespace

std::size_t PerspectiveCompositor::composite(Sheets sheets, int slice, const SheetReading& reading,
                                             const PlaneBox& box, const SheetCover* cover,
                                             Layer& layer) {
    box_ = seenBox(sheets, reading, box, cover);
    if (box_.empty()) return 0;
    pixels_ = 0;
    number_ = slice;
    isCut_ = plane_.isCut(slice);
    const SheetLayout& layout = sheets.front()->layout();
    const glm::dvec2 start = reading.startOfWhole();
    const glm::ivec2 size = box_.size();
    columns_.set(start.x, reading.scale, box_.min.x, size.x,
                 {reading.origin.x, layout.sizePixels.x});
    rows_.set(start.y, reading.scale, box_.min.y, size.y, {reading.origin.y, layout.sizePixels.y});
    slice_ = {{}, sheets.front()->pitch(), scales_, rows_.taps, columns_.taps, layer.channels};
    for (std::size_t p = 0; p < sheets.size(); ++p) slice_.sheets[p] = sheets[p]->row(0);
    findTiles(reading, layout.tiles().x);
    for (int y = box_.min.y; y < box_.max.y; ++y) addRow(y, layer);
    flush();
    return pixels_;
}

// Restricts a box to pixels that read tiles which may be other than zero.
PlaneBox PerspectiveCompositor::seenBox(Sheets sheets, const SheetReading& reading,
                                        const PlaneBox& box, const SheetCover* cover) {
    if (box.empty()) return {};
    const SheetBox read = readBox(reading, box, sheets.front()->layout());
    if (read.min.y >= read.max.y) return {};
    findFull(sheets, read.min.y, read.max.y, cover);
    std::uint64_t any = 0;
    int firstTile = 0, lastTile = 0;
    for (std::size_t i = 0; i < words_; ++i) {
        const std::uint64_t word = seen_[i];
        if (word == 0) continue;
        if (any == 0) firstTile = int(64 * i) + std::countr_zero(word);
        lastTile = int(64 * i) + int(std::bit_width(word));
        any |= word;
    }
    if (any == 0) return {};
    const SheetBox full{{kTilePixels * firstTile, firstFull_}, {kTilePixels * lastTile, lastFull_}};
    const glm::ivec2 x = readersOf(reading, 0, full.min.x, full.max.x, box);
    const glm::ivec2 y = readersOf(reading, 1, full.min.y, full.max.y, box);
    return {{x.x, y.x}, {x.y, y.y}};
}

// Looks at all rows of tiles with any of the sheet rows [firstRow, lastRow).
void PerspectiveCompositor::findFull(Sheets sheets, int firstRow, int lastRow,
                                     const SheetCover* cover) {
    words_ = wordsOfRow(*sheets.front());
    firstTileRow_ = firstRow / kTilePixels;
    const int lastTileRow = (lastRow - 1) / kTilePixels;
    const std::size_t perRow = kTilePixels * words_;
    full_.assign(perRow * std::size_t(lastTileRow - firstTileRow_ + 1), 0);
    firstFull_ = lastFull_ = 0;
    for (int row = firstTileRow_; row <= lastTileRow; ++row) {
        const std::span rows =
            std::span(full_).subspan(perRow * std::size_t(row - firstTileRow_), perRow);
        unsigned any = 0;
        for (const Sheet* sheet : sheets) any |= findFullRows(*sheet, row, words_, rows);
        if (any == 0) continue;
        if (cover) cover->clearHidden(row, words_, rows);
        if (lastFull_ == 0) firstFull_ = kTilePixels * row + std::countr_zero(any);
        lastFull_ = kTilePixels * row + int(std::bit_width(any));
    }
    seen_.assign(words_, 0);
    for (std::size_t i = 0; i < full_.size(); ++i) seen_[i % words_] |= full_[i];
}

void PerspectiveCompositor::addRow(int y, Layer& layer) {
    const int firstRow = rows_.first[std::size_t(y - box_.min.y)];
    std::fill(seen_.begin(), seen_.end(), 0);
    std::uint64_t any = 0;
    const int rowsKnown = int(full_.size() / words_) + kTilePixels * firstTileRow_;
    for (int row = std::max(firstRow, kTilePixels * firstTileRow_);
         row < std::min(firstRow + rows_.taps, rowsKnown); ++row) {
        const std::size_t place = words_ * std::size_t(row - kTilePixels * firstTileRow_);
        for (std::size_t i = 0; i < words_; ++i) any |= seen_[i] |= full_[place + i];
    }
    if (any == 0) return;
    int first = box_.min.x;
    int last = box_.min.x;
    forEachRun(seen_, [&](int firstTile, int lastTile) {
        const int from = tiles_[std::size_t(firstTile)].x;
        const int to = tiles_[std::size_t(lastTile - 1)].y;
        if (to <= from) return;
        // Runs with short gaps are joined.
        if (from > last + kShortGap) {
            addRun({first, y}, last, layer);
            first = from;
        }
        last = std::max(last, to);
    });
    addRun({first, y}, last, layer);
}

// Finds the columns of the box that read each tile.
void PerspectiveCompositor::findTiles(const SheetReading& reading, int tiles) {
    tiles_.clear();
    for (int tile = 0; tile < tiles; ++tile)
        tiles_.push_back(readersOf(reading, 0, kTilePixels * tile, kTilePixels * (tile + 1), box_));
}

// Adds pixels [first.x, last) of a row.
void PerspectiveCompositor::addRun(glm::ivec2 first, int last, Layer& layer) {
    if (first.x >= last) return;
    layer.extend(first.y, first.x, last);
    pixels_ += std::size_t(last - first.x);
    const auto row = std::size_t(first.y - box_.min.y);
    const std::size_t firstOfRow = slice_.pitch * std::size_t(rows_.first[row]);
    for (int x = first.x; x < last;) {
        const auto column = std::size_t(x - box_.min.x);
        // Built in place: a copy would wait for the writes.
        ScaledRun& run = runs_.emplace_back();
        run.place = firstOfRow + std::size_t(layer.channels * columns_.first[column]);
        run.rowWeights = rows_.of(row);
        run.first = &columns_.first[column];
        run.columnWeights = columns_.of(column);
        run.pairWeights = columns_.pairs.empty() ? nullptr : &columns_.pairs[column];
        run.pixels = std::min(last - x, kMostScaled);
        run.layer = layer.pixel({x, first.y});
        // The base plane is never so coarse that one pixel reads this many columns.
        while (run.pixels > 1 && run.columns(columns_.taps) > kMostScaledColumns) run.pixels /= 2;
        run.steps = stepsOf({x, first.y}, run.pixels);
        x += run.pixels;
        // The next run reuses shares_.
        if (isCut_) flush();
    }
}

void PerspectiveCompositor::flush() {
    if (!runs_.empty()) overScaled(slice_, runs_);
    runs_.clear();
}

// Returns the steps that each pixel's opacity counts for; null: one.
const float* PerspectiveCompositor::stepsOf(glm::ivec2 first, int pixels) {
    const float* steps = steps_ ? steps_->at(first) : nullptr;
    if (!isCut_) return steps;
    shares_.resize(std::size_t(pixels) + kStepsSpare);
    for (int i = 0; i < pixels; ++i) {
        const auto share = float(plane_.shareOf(number_, first + glm::ivec2(i, 0)));
        shares_[std::size_t(i)] = steps ? share * steps[i] : share;
    }
    return shares_.data();
}

}  // namespace deltasplat
