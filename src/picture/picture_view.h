// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>

#include "base/text.h"
#include "composite/layer.h"
#include "composite/slab_renderer.h"
#include "deltasplat/error.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/picture_filter.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"
#include "optics/hold_rule.h"
#include "picture/draw_plan.h"
#include "screen/warp.h"
#include "splat/digit_voxels.h"
#include "view/base_plane.h"

namespace deltasplat {

/// @throw Error(kUsage) unless the image has the size of `part`, within a picture of `size`
inline void requirePart(const PixelBox& part, glm::ivec2 size, const Image& image) {
    const auto text = [](const PixelBox& box) {
        return dimsText(box.size()) + " pixels from " + std::to_string(box.min.x) + "," +
               std::to_string(box.min.y) + " on";
    };
    const bool isWithin = !part.empty() && part.min.x >= 0 && part.min.y >= 0 &&
                          part.max.x <= size.x && part.max.y <= size.y;
    if (!isWithin) {
        throw Error(ErrorCode::kUsage, "part of a picture", text(part),
                    "some of its " + dimsText(size));
    }
    if (image.size == part.size() &&
        image.rgba.size() == std::size_t{4} * std::size_t(image.size.x) * std::size_t(image.size.y))
        return;
    throw Error(ErrorCode::kUsage, "image", dimsText(image.size) + " pixels",
                dimsText(part.size()) + ", those of the part");
}

/// The place of a view's base plane, in plain numbers.
struct PlanePlace {
    Factorization view;                                 ///< of the volume's own voxels
    Subdivision parts;                                  ///< how these are divided
    Factorization thin;                                 ///< of the parts: subdivided(view, parts)
    int firstSlice = 0;                                 ///< as SheetLayout::firstSlice
    glm::ivec2 firstVoxel{0};                           ///< as SheetLayout::firstVoxel
    double resolution = 1;                              ///< parallel: sheet pixels per voxel
    double offsetPixels = 0;                            ///< parallel: as SheetLayout::offsetPixels
    double spacing = 1;                                 ///< from an eye: slope between pixels
    PictureFilter filter = PictureFilter::kCatmullRom;  ///< as SplatOptions::filter
    /// The colour of opacity 1, if layers hold opacity only.
    std::optional<glm::dvec3> color;
};

/// All that is needed to show the base plane of a view once its slabs are rendered.
class PlaneView {
  public:
    PlaneView(const Camera& camera, const PlanePlace& place);

    const PlanePlace& place() const { return place_; }
    const BasePlane& plane() const { return plane_; }
    /// Prepares a layer for showPart(). Call it once per layer.
    void finish(Layer& layer) const;
    /// Whether finish() changes the layer.
    bool finishChangesLayer() const { return place_.view.eye && place_.color; }
    /// Writes a finished layer into a part of the picture: into all pixels of a parallel view, or
    /// into those of the eye's region where the layer is not empty.
    /// @param whole  box of the larger layer, if `finished` is a part, which must include readBy()
    /// @return how much this can enlarge a difference of layers at most
    double showPart(const Layer& finished, const PicturePart& part,
                    const PlaneBox& whole = {}) const;
    /// Returns a box of base plane pixels that includes all that showing `pixels` reads.
    PlaneBox readBy(const PixelBox& pixels) const;

  private:
    BasePlane makePlane() const;
    void lengthenSteps(Layer& layer) const;

    Camera camera_;
    PlanePlace place_;
    BasePlane plane_;
};

/// @throw Error(kUsage) unless the image has the camera's size
void requireSize(const Camera& camera, const Image& image);

/// A view of a picture of a volume that is not empty: its slabs and its base plane.
class PictureView {
  public:
    /// @param scene,camera  must outlive the view
    /// @param axis    the plan's axis
    /// @param memory  for layers and sheets
    PictureView(const PreparedScene::Impl& scene, const Camera& camera, const ViewPlan& plan,
                std::shared_ptr<const PreparedAxis> axis, KeptMemory& memory);
    // Slabs refer to this object.
    PictureView(const PictureView&) = delete;
    PictureView& operator=(const PictureView&) = delete;

    const SlabInput& slabs() const { return *slabs_; }
    const ViewPlan& plan() const { return plan_; }
    const PreparedAxis& axis() const { return *axis_; }
    const PlaneView& plane() const { return *plane_; }
    /// From (slice, u, v) of the volume's own voxels to the world.
    glm::dmat4 worldFromSlices() const;
    /// Writes the base plane into a part of the picture. May change the layer.
    /// @param whole  as PlaneView::showPart
    /// @return how much this can enlarge a difference of layers at most
    double show(Layer& layer, const PicturePart& part, const PlaneBox& whole = {}) const;
    bool showChangesLayer() const { return plane_->finishChangesLayer(); }
    /// Largest difference of a layer from the exact layer.
    ErrorBound errorBound() const;

  private:
    PlanePlace placePlane() const;

    const PreparedScene::Impl& scene_;
    const Camera& camera_;
    ViewPlan plan_;
    std::shared_ptr<const PreparedAxis> axis_;
    std::optional<StepColors> colors_;        // if the axis' colours are for other steps or unlit
    std::optional<DigitVoxels> digitVoxels_;  // with several digits and no own colours
    SheetLayout layout_;
    std::optional<PlaneView> plane_;
    std::optional<SlabInput> slabs_;
};

}  // namespace deltasplat
