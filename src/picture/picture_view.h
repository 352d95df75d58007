// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "composite/slab_renderer.h"
#include "optics/hold_rule.h"
#include "picture/draw_plan.h"
#include "picture/plane_view.h"
#include "splat/digit_voxels.h"

namespace deltasplat {

/// @throw Error(kUsage) if the image has not the camera's size
void requireSize(const Camera& camera, const Image& image);

/// A view of a picture, of a volume that is not empty: what its slabs are made of, how they lie on
/// the base plane, and how that is seen.
class PictureView {
  public:
    /// @param scene,camera  must outlive it
    /// @param axis    that the plan asks for
    /// @param memory  for layers and sheets
    PictureView(const PreparedScene::Impl& scene, const Camera& camera, const ViewPlan& plan,
                std::shared_ptr<const PreparedAxis> axis, KeptMemory& memory);
    // What slabs are made of refers to it.
    PictureView(const PictureView&) = delete;
    PictureView& operator=(const PictureView&) = delete;

    const SlabInput& slabs() const { return *slabs_; }
    const ViewPlan& plan() const { return plan_; }
    const PreparedAxis& axis() const { return *axis_; }
    const PlaneView& plane() const { return *plane_; }
    /// From (slice, u, v) of the volume's own voxels to the world.
    glm::dmat4 worldFromSlices() const;
    /// Writes what is seen of the base plane into a part of the picture. Changes the layer on the
    /// way.
    /// @param whole  as PlaneView::showPart
    /// @return the most that this can enlarge a difference of layers
    double show(Layer& layer, const PicturePart& part, const PlaneBox& whole = {}) const;
    /// Whether show() changes the layer.
    bool showChangesLayer() const { return plane_->finishChangesLayer(); }
    /// Most that a layer may differ from the exact one.
    ErrorBound errorBound() const;

  private:
    PlanePlace placePlane() const;

    const PreparedScene::Impl& scene_;
    const Camera& camera_;
    ViewPlan plan_;
    std::shared_ptr<const PreparedAxis> axis_;
    std::optional<StepColors> colors_;        // if the axis' are those of other steps, or not lit
    std::optional<DigitVoxels> digitVoxels_;  // of several digits, without own colours
    SheetLayout layout_;
    std::optional<PlaneView> plane_;
    std::optional<SlabInput> slabs_;
};

}  // namespace deltasplat
