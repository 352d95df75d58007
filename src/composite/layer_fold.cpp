// SPDX-License-Identifier: Apache-2.0
#include "composite/layer_fold.h"

#include <utility>

#include "composite/find_covered.h"

namespace deltasplat {

Layer LayerFold::take(const PlaneBox& box) {
    std::unique_lock lock(mutex_);
    ++taken_;
    Layer layer({}, channels_, *front_.values.get_allocator().resource());
    if (idle_.empty()) {
        lock.unlock();
        // Slabs of the same length reach boxes that differ by a pixel.
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
    // The last ones are merged by all threads together.
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

// Nobody else merges meanwhile.
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

}  // namespace deltasplat
