// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "composite/slab_renderer.h"
#include "optics/hold_rule.h"
#include "picture/plane_view.h"
#include "picture/prepared_axis.h"
#include "picture/sheet_plan.h"
#include "splat/digit_voxels.h"
#include "volume/seen_cone.h"

namespace deltasplat {

/// How a camera sees a scene.
struct ViewPlan {
    /// @param keepsSlices  whether each has to be drawn by itself
    ViewPlan(const PreparedScene::Impl& scene, const Camera& camera, bool keepsSlices,
             const Listener& listener);

    /// One, or one for each region of what an eye sees, of the volume's own voxels.
    std::vector<Factorization> views;
    SheetPlan sheets;  ///< all of a picture is drawn alike
};

/// Of a view, how long the way from one slice to the next is that colours are for, as a multiple of
/// the straight one; from an eye, each pixel has its own.
double stepsOf(const Factorization& view, const Volume& volume);

/// Returns the index position (x, y, z) that lines of sight of a view begin at.
/// @param view  from an eye
glm::dvec3 indexOfEye(const Factorization& view);

/// Returns what of the volume a view from an eye may show.
SeenCone seenCone(const PreparedScene::Impl& scene, const Camera& camera, const Factorization& view,
                  const SheetPlan& plan);

/// @throw Error(kUsage) if the image has not the camera's size
void requireSize(const Camera& camera, const Image& image);

/// A view of a picture, of a volume that is not empty: what its slabs are made of, how they lie on
/// the base plane, and how that is seen.
class PictureView {
  public:
    /// @param axis    of the view's slice axis
    /// @param memory  for layers and sheets
    PictureView(const PreparedScene::Impl& scene, const Camera& camera, const Factorization& view,
                const SheetPlan& plan, std::shared_ptr<const PreparedAxis> axis,
                KeptMemory& memory);
    // What slabs are made of refers to it.
    PictureView(const PictureView&) = delete;
    PictureView& operator=(const PictureView&) = delete;

    const SlabInput& slabs() const { return *slabs_; }
    const Footprint& footprint() const { return footprint_; }
    const PreparedAxis& axis() const { return *axis_; }
    const Camera& camera() const { return camera_; }
    const PlaneView& plane() const { return *plane_; }
    /// From (slice, u, v) of the volume's own voxels to the world.
    glm::dmat4 worldFromSlices() const;
    /// Writes what is seen of the base plane into a part of the picture. Changes the layer on the
    /// way.
    /// @param whole  as PlaneView::showPart
    /// @return the most that this can enlarge a difference of layers
    double show(Layer& layer, const PicturePart& part, const PlaneBox& whole = {}) const;
    /// Makes of a layer, once, what showPart() shows.
    void finish(Layer& layer) const { plane_->finish(layer); }
    /// Writes what is seen of a finished layer into a part of the picture.
    /// @return as show()
    double showPart(const Layer& finished, const PicturePart& part) const {
        return plane_->showPart(finished, part);
    }
    /// Whether show() and finish() change the layer.
    bool showChangesLayer() const { return plane_->finishChangesLayer(); }
    /// Most that a layer may differ from the exact one.
    ErrorBound errorBound() const;

  private:
    PlanePlace placePlane() const;

    const PreparedScene::Impl& scene_;
    const Camera& camera_;
    Factorization view_;
    std::shared_ptr<const PreparedAxis> axis_;
    double steps_;
    std::optional<StepColors> colors_;  // if the axis' are those of other steps, or not lit
    Factorization thinView_;
    Footprint footprint_;
    std::optional<DigitVoxels> digitVoxels_;  // of several digits, without own colours
    SheetLayout layout_;
    std::optional<PlaneView> plane_;
    std::optional<SlabInput> slabs_;
};

}  // namespace deltasplat
