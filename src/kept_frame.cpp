// SPDX-License-Identifier: Apache-2.0
#include "kept_frame.h"

#include <utility>

namespace deltasplat {

const PictureView& KeptFrame::addView(std::unique_ptr<const PictureView> picture) {
    const PictureView& view = *picture;
    {
        const std::lock_guard lock(mutex_);
        views_.push_back({std::move(picture), nullptr});
    }
    changed_.notify_all();
    return view;
}

const Layer& KeptFrame::addLayer(Layer layer) {
    auto kept = std::make_unique<const Layer>(std::move(layer));
    const Layer& added = *kept;
    {
        const std::lock_guard lock(mutex_);
        views_.back().layer = std::move(kept);
    }
    changed_.notify_all();
    return added;
}

void KeptFrame::end() {
    {
        const std::lock_guard lock(mutex_);
        hasEnded_ = true;
    }
    changed_.notify_all();
}

const PictureView* KeptFrame::view(std::size_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return hasEnded_ || views_.size() > number; });
    return views_.size() > number ? views_[number].picture.get() : nullptr;
}

const Layer* KeptFrame::layer(std::size_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return hasEnded_ || views_[number].layer; });
    return views_[number].layer.get();
}

}  // namespace deltasplat
