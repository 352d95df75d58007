// SPDX-License-Identifier: Apache-2.0
#include "kept_frame.h"

#include <utility>

namespace deltasplat {

void KeptFrame::addView(std::shared_ptr<const PictureView> view) {
    {
        const std::lock_guard lock(mutex_);
        const bool isWanted = view != nullptr;
        views_.push_back({std::move(view), nullptr, isWanted});
    }
    changed_.notify_all();
}

void KeptFrame::addLayer(std::shared_ptr<const Layer> layer) {
    {
        const std::lock_guard lock(mutex_);
        if (!views_.back().isWanted) return;
        views_.back().layer = std::move(layer);
    }
    changed_.notify_all();
}

void KeptFrame::end() {
    {
        const std::lock_guard lock(mutex_);
        hasEnded_ = true;
    }
    changed_.notify_all();
}

std::shared_ptr<const PictureView> KeptFrame::takeView(std::size_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return hasEnded_ || views_.size() > number; });
    if (views_.size() <= number) return nullptr;
    return std::move(views_[number].view);
}

std::shared_ptr<const Layer> KeptFrame::takeLayer(std::size_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return hasEnded_ || views_[number].layer; });
    return std::move(views_[number].layer);
}

void KeptFrame::dropLayer(std::size_t number) {
    std::shared_ptr<const Layer> dropped;  // freed without the lock
    const std::lock_guard lock(mutex_);
    if (views_.size() <= number) return;
    views_[number].isWanted = false;
    dropped = std::move(views_[number].layer);
}

}  // namespace deltasplat
