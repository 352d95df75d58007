// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "composite/layer.h"
#include "kept_memory.h"
#include "picture_view.h"

namespace deltasplat {

/// What a frame that is being rendered, or was, leaves to the next one: what its views are made of,
/// and what they come to. Thread-safe: one thread adds, another takes. What nobody can take any
/// more is not held.
class KeptFrame {
  public:
    /// Adds the next view; null if it is not to be compared with.
    void addView(std::shared_ptr<const PictureView> view);
    /// Adds the layer of the last view, not finished yet (PictureView::finish).
    void addLayer(std::shared_ptr<const Layer> layer);
    /// Says that nothing more comes.
    void end();

    /// Waits for a view, and takes it. Null if there is none to compare with.
    std::shared_ptr<const PictureView> takeView(std::size_t number);
    /// Waits for the layer of a view that has been taken, and takes it. Null if it could not be
    /// rendered.
    std::shared_ptr<const Layer> takeLayer(std::size_t number);
    /// Says that the layer will not be taken.
    void dropLayer(std::size_t number);

  private:
    struct View {
        std::shared_ptr<const PictureView> view;
        std::shared_ptr<const Layer> layer;
        bool isWanted;  // the layer
    };

    std::mutex mutex_;  // guards all below
    std::condition_variable changed_;
    std::vector<View> views_;
    bool hasEnded_ = false;
};

/// What a frame is rendered behind, and as.
struct FrameStep {
    std::shared_ptr<KeptFrame> before;  ///< null: there is none
    KeptFrame& now;
    /// For layers and sheets. Layers that are left hold it.
    std::shared_ptr<KeptMemory> memory;
};

}  // namespace deltasplat
