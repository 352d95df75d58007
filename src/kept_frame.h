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

/// A frame that is being rendered, or was: what its views were made of and came to, for the next
/// one to take from. One thread writes, another may read.
class KeptFrame {
  public:
    /// What views refer to. A volume that was borrowed may be gone when they are read.
    std::shared_ptr<const PreparedScene::Impl> scene;
    Camera camera;
    KeptMemory memory;

    /// Adds the next view.
    const PictureView& addView(std::unique_ptr<const PictureView> picture);
    /// Adds the layer of the last view, not finished yet (PictureView::finish).
    const Layer& addLayer(Layer layer);
    /// Says that nothing more comes.
    void end();

    /// Waits for a view. Null if there is none.
    const PictureView* view(std::size_t number);
    /// Waits for the layer of a view that there is. Null if it could not be rendered.
    const Layer* layer(std::size_t number);

  private:
    struct View {
        std::unique_ptr<const PictureView> picture;
        std::unique_ptr<const Layer> layer;
    };

    std::mutex mutex_;  // guards all below
    std::condition_variable changed_;
    std::vector<View> views_;
    bool hasEnded_ = false;
};

/// What a frame is rendered behind, and as.
struct FrameStep {
    KeptFrame* before;  ///< null: there is none
    KeptFrame& now;
};

}  // namespace deltasplat
