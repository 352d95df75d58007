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

/// @throw Error(kUsage) unless an image has the size of a part of a picture of `size`
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

/// Where the base plane of a view lies, in plain numbers.
struct PlanePlace {
    Factorization view;        ///< of the volume's own voxels
    Subdivision parts;         ///< what these are divided into
    Factorization thin;        ///< of those: subdivided(view, parts)
    int firstSlice = 0;        ///< as SheetLayout::firstSlice
    glm::ivec2 firstVoxel{0};  ///< as SheetLayout::firstVoxel
    double resolution = 1;     ///< parallel: sheet pixels a voxel
    double offsetPixels = 0;   ///< parallel: as SheetLayout::offsetPixels
    double spacing = 1;        ///< from an eye: from one pixel to the next, in slopes
    PictureFilter filter = PictureFilter::kCatmullRom;  ///< as SplatOptions::filter
    /// The colour that opacity 1 has, where opacity is all that layers hold.
    std::optional<glm::dvec3> color;
};

/// How the base plane of a view is seen: all that showing it takes once its slabs are rendered,
/// whoever did that.
class PlaneView {
  public:
    PlaneView(const Camera& camera, const PlanePlace& place);

    const PlanePlace& place() const { return place_; }
    const BasePlane& plane() const { return plane_; }
    /// Makes of a layer, once, what showPart() shows.
    void finish(Layer& layer) const;
    /// Whether finish() changes the layer.
    bool finishChangesLayer() const { return place_.view.eye && place_.color; }
    /// Writes what is seen of a finished layer into a part of the picture: into all pixels of a
    /// parallel view, and into those of the region, where it is not empty, of one from an eye.
    /// @param whole  where the layer is a part of a larger one: that one's box. The part shows the
    ///               same if it has what readBy() says.
    /// @return the most that this can enlarge a difference of layers
    double showPart(const Layer& finished, const PicturePart& part,
                    const PlaneBox& whole = {}) const;
    /// Returns the base plane's pixels that showing some of the picture's may read, and more.
    PlaneBox readBy(const PixelBox& pixels) const;

  private:
    BasePlane makePlane() const;
    void lengthenSteps(Layer& layer) const;

    Camera camera_;
    PlanePlace place_;
    BasePlane plane_;
};

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
