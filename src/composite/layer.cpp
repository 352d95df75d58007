// SPDX-License-Identifier: Apache-2.0
#include "composite/layer.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "base/parallel.h"

namespace deltasplat {

void Layer::setBox(const PlaneBox& planeBox) {
    box = planeBox;
    values.resize(std::size_t(channels) * box.size().x * box.size().y);
    spans.assign(std::size_t(box.size().y), kNothing);
}

void Layer::fillZero(int y, int first, int last) {
    if (first >= last) return;
    std::fill_n(pixel({box.min.x + first, y}), std::size_t(channels) * (last - first), 0.0f);
}

void Layer::widen(int y, glm::ivec2 columns) {
    glm::ivec2& span = spans[std::size_t(y - box.min.y)];
    if (span.x >= span.y) {
        fillZero(y, columns.x, columns.y);
        span = columns;
    } else {
        fillZero(y, columns.x, span.x);
        fillZero(y, span.y, columns.y);
        span = {std::min(span.x, columns.x), std::max(span.y, columns.y)};
    }
}

void Layer::clearRest(int y) {
    glm::ivec2 span = spans[std::size_t(y - box.min.y)];
    if (span.x >= span.y) span = glm::ivec2(box.size().x);
    fillZero(y, 0, span.x);
    fillZero(y, span.y, box.size().x);
}

void Layer::clearRest() {
    parallelForChunks(std::size_t(box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) clearRest(box.min.y + int(row));
    });
}

void mergeRowBehind(Layer& front, const LayerRow& row, int y) {
    const glm::ivec2 span = row.span;
    if (span.x >= span.y) return;
    const glm::ivec2 first(row.firstColumn + span.x, y);
    front.extend(y, first.x, first.x + span.y - span.x);
    mergeBehind(front.pixel(first), row.values + front.channels * std::ptrdiff_t{span.x},
                std::size_t(span.y - span.x), front.channels);
}

void mergeRowBehind(Layer& front, const Layer& layer, int y) {
    if (y < layer.box.min.y || y >= layer.box.max.y) return;
    const auto row = std::size_t(y - layer.box.min.y);
    const std::size_t width = std::size_t(layer.channels) * std::size_t(layer.box.size().x);
    mergeRowBehind(front, {layer.values.data() + row * width, layer.box.min.x, layer.spans[row]},
                   y);
}

Layer LayerFold::take(const PlaneBox& box) {
    std::unique_lock lock(mutex_);
    ++taken_;
    Layer layer({}, channels_, *front_.values.get_allocator().resource());
    if (idle_.empty()) {
        lock.unlock();
        // Boxes of slabs of one length differ by a pixel.
        const glm::ivec2 size = box.size() + 1;
        layer.values.reserve(std::size_t(channels_) * size.x * size.y);
    } else {
        layer = std::move(idle_.back());
        idle_.pop_back();
        lock.unlock();
    }
    layer.setBox(box);
    return layer;
}

std::shared_ptr<const CoveredCells> LayerFold::covered() {
    const std::lock_guard lock(mutex_);
    return covered_;
}

void LayerFold::addFront() {
    std::unique_lock lock(mutex_);
    hasFront_ = true;
    if (taken_ < done_.size()) mergeReady(lock);
}

void LayerFold::add(std::size_t number, Layer layer) {
    std::unique_lock lock(mutex_);
    done_[number] = std::move(layer);
    // All threads together merge the last layers.
    if (hasFront_ && !merging_ && taken_ < done_.size()) mergeReady(lock);
}

void LayerFold::mergeReady(std::unique_lock<std::mutex>& lock) {
    merging_ = true;
    const auto isNextReady = [&] { return next_ < done_.size() && done_[next_]; };
    do {
        while (isNextReady()) {
            Layer layer = std::move(*done_[next_]);
            done_[next_++].reset();
            lock.unlock();
            for (int y = layer.box.min.y; y < layer.box.max.y; ++y)
                mergeRowBehind(front_, layer, y);
            lock.lock();
            idle_.push_back(std::move(layer));
        }
        findCovered(lock);
    } while (isNextReady());
    merging_ = false;
}

// Only one thread merges at a time.
void LayerFold::findCovered(std::unique_lock<std::mutex>& lock) {
    CoveredCells cells = *covered_;
    lock.unlock();
    addCovered(front_, cells);
    lock.lock();
    covered_ = std::make_shared<const CoveredCells>(std::move(cells));
}

void LayerFold::finishRow(int y) {
    for (std::size_t i = next_; i < done_.size(); ++i) mergeRowBehind(front_, *done_[i], y);
}

namespace {

// Returns the columns in which no base plane row of [first, last) is known to be zero.
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

// Looking at a cell takes about as long as compositing two pixels. Successful looks may cost a
// thirtieth of compositing; unsuccessful ones become rarer and rarer.
constexpr std::size_t kLeastBetween = 64;  // pixels per cell
constexpr std::size_t kMostBetween = 1024;
// Cover for all later slices grows slowly.
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
