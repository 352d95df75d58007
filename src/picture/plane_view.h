// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "base/text.h"
#include "composite/layer.h"
#include "deltasplat/error.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/picture_filter.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"
#include "screen/warp.h"
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

}  // namespace deltasplat
