// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
#include "picture/render_views.h"
#include "screen/deep_builder.h"

namespace deltasplat {

/// The slices of a sample, and their slabs.
struct DeepCut {
    int firstSlice;               ///< smallest number
    int lastSlice;                ///< largest number
    std::vector<SeenSlab> slabs;  ///< from front to back
};

/// Cuts visible slabs at multiples of `slicesPerSample` undivided slices, or, if 0, at all slices.
/// @param seen  from front to back; so is the result
std::vector<DeepCut> cutInDepth(const std::vector<SeenSlab>& seen, bool frontToBack,
                                const Subdivision& parts, int slicesPerSample);

/// Renders the views of a picture cut by cut, from front to back, and shows every stage.
class DeepSink : public ViewSink {
  public:
    /// @param slicesPerSample  as cutInDepth
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
    std::optional<Image> group_;  // of the current group
    std::optional<StagesBehind> behind_;
};

}  // namespace deltasplat
