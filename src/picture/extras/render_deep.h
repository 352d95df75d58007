// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
#include "picture/render_views.h"
#include "screen/deep_builder.h"

namespace deltasplat {

/// Slices of a view that make one sample, and which slabs they belong to.
struct DeepCut {
    int firstSlice;               ///< the smallest
    int lastSlice;                ///< the largest
    std::vector<SeenSlab> slabs;  ///< from the front on
};

/// Cuts what is seen of slabs at multiples of `slicesPerSample` undivided slices, or, if that is 0,
/// at every slice, from the front on.
/// @param seen  from the front on
std::vector<DeepCut> cutInDepth(const std::vector<SeenSlab>& seen, bool frontToBack,
                                const Subdivision& parts, int slicesPerSample);

/// Renders the views of a picture cut by cut, from the front on, and shows each time what there is
/// so far.
class DeepSink : public ViewSink {
  public:
    /// @param slicesPerSample  as cutInDepth takes it
    /// @param image  of the camera's size, clear; becomes the flat picture
    DeepSink(int slicesPerSample, DeepStages& stages, Image& image)
        : slicesPerSample_(slicesPerSample), stages_(stages), image_(image) {}

    DrawnFor drawnFor() const override { return DrawnFor::kDepths; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl> group,
                    const PixelBox& part) override;
    void endGroup() override;
    void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) override;
    bool isAnyBeyond(float least) const override;

  private:
    int slicesPerSample_;
    DeepStages& stages_;
    Image& image_;
    std::optional<Image> group_;  // of the group in hand
    std::optional<StagesBehind> behind_;
};

}  // namespace deltasplat
