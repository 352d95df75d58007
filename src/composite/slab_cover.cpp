// SPDX-License-Identifier: Apache-2.0
#include "composite/slab_cover.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace deltasplat {

namespace {

// Of rows [first, last) of the base plane, the columns that none of them is sure to be zero in.
glm::ivec2 columnsOf(const Layer& layer, int first, int last) {
    if (first < layer.box.min.y || last > layer.box.max.y) return {0, 0};
    glm::ivec2 columns(0, layer.box.size().x);
    for (int y = first; y < last; ++y) {
        const glm::ivec2 span = layer.spans[std::size_t(y - layer.box.min.y)];
        columns = {std::max(columns.x, span.x), std::min(columns.y, span.y)};
    }
    if (columns.x >= columns.y) return {0, 0};
    return columns + layer.box.min.x;
}

bool isOpaque(const Layer& layer, const PlaneBox& pixels) {
    for (int y = pixels.min.y; y < pixels.max.y; ++y) {
        const float* opacity = layer.pixel({pixels.min.x, y}) + layer.channels - 1;
        for (int x = pixels.min.x; x < pixels.max.x; ++x, opacity += layer.channels)
            if (*opacity != 1.0f) return false;
    }
    return true;
}

}  // namespace

bool addCovered(const Layer& layer, CoveredCells& cells) {
    bool isNew = false;
    for (int y = 0; y < cells.size().y; ++y) {
        const PlaneBox row = cells.pixelsOf({0, y});
        const glm::ivec2 columns = columnsOf(layer, row.min.y, row.max.y);
        const glm::ivec2 reached = cells.cellsOf(0, columns);
        for (int x = reached.x; x < reached.y; ++x) {
            const PlaneBox pixels = cells.pixelsOf({x, y});
            if (cells.isCovered({x, y}) || pixels.min.x < columns.x || pixels.max.x > columns.y)
                continue;
            if (!isOpaque(layer, pixels)) continue;
            cells.cover({x, y});
            isNew = true;
        }
    }
    if (isNew) cells.settle();
    return isNew;
}

namespace {

// A look at a cell takes about as long as compositing two pixels. Looks that find something are
// worth a thirtieth of that time, and those that find nothing get rarer and rarer.
constexpr std::size_t kLeastBetween = 64;  // pixels a cell
constexpr std::size_t kMostBetween = 1024;
// What is covered from now on grows slowly.
constexpr int kSlicesBetween = 8;

}  // namespace

NeededPixels SlabCover::next(const SheetReading& reading, const SheetBox& read,
                             const SheetLayout& layout) {
    const glm::ivec2 size = cells_->size();
    const auto cells = std::size_t(size.x) * std::size_t(size.y);
    if (pixels_ >= between_ * cells) look();
    NeededPixels needed{read.min.y, read.max.y};
    if (!cells_->any()) return needed;
    if (slices_-- == 0) {
        fromNowOn_.set(*cells_, reading, readingOf(plane_, layout, lastSlice_), layout);
        slices_ = kSlicesBetween - 1;
    }
    ofSlice_.set(*cells_, reading, reading, layout);
    needed.cover = &ofSlice_;
    needed.fromNowOn = &fromNowOn_;
    return needed;
}

void SlabCover::look() {
    pixels_ = 0;
    slices_ = 0;
    auto cells = std::make_shared<CoveredCells>(*cells_);
    const bool isNew = addCovered(layer_, *cells);
    between_ = isNew ? kLeastBetween : std::min(2 * between_, kMostBetween);
    cells_ = std::move(cells);
}

}  // namespace deltasplat
