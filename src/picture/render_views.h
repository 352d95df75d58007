// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/kept_memory.h"
#include "base/text.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/ingest/volume.h"
#include "picture/picture_view.h"

namespace deltasplat {

struct PlannedView {
    const PreparedScene::Impl& scene;  ///< of all voxels, or of a far group
    const Camera& camera;
    const ViewPlan& plan;
    /// Has a packer only for DrawnFor::kPixels; words then come from PreparedAxis::withWords.
    std::shared_ptr<const PreparedAxis> axis;
    KeptMemory& memory;

    std::unique_ptr<const PictureView> view(std::shared_ptr<const PreparedAxis> words) const {
        return std::make_unique<const PictureView>(scene, camera, plan, std::move(words), memory);
    }
};

/// Takes the views of a picture from front to back.
class ViewSink {
  public:
    virtual ~ViewSink() = default;

    virtual DrawnFor drawnFor() const = 0;
    /// The views up to endGroup() show a far group, which lies behind the earlier groups.
    /// @param part  pixels that may show the group
    virtual void beginGroup(std::shared_ptr<const PreparedScene::Impl> group,
                            const PixelBox& part) = 0;
    virtual void endGroup() = 0;
    /// @param stats  gets the sink's times except `renderSeconds`, and its error bounds
    virtual void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) = 0;
    /// Returns whether any value of the result exceeds `least`.
    virtual bool isAnyBeyond(float least) const = 0;
};

/// Plans a picture and gives its views to a sink. Warns if the result shows nothing.
/// @param camera,memory  must outlive what the sink keeps
RenderStats renderViews(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        ViewSink& sink, const Listener& listener);

/// @param image  of the camera's size, clear
RenderStats renderImage(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        Image& image, const Listener& listener);

/// @param front  layer in front of them, if any
Layer renderSlabs(const SlabInput& input, std::vector<SeenSlab> seen, RenderStats& stats,
                  const Listener& listener, std::optional<Layer> front = {});

/// @param gain  how much showing the view can enlarge a difference of layers at most
void addBound(const ErrorBound& bound, double gain, RenderStats& stats);

/// Returns whether any number is farther from 0 than `least`.
bool isAnyBeyond(std::span<const float> values, float least);

/// Returns the warning for an empty picture of a volume that has something to show.
/// @param tooSmall  another possible reason: "is far smaller than a pixel"
inline std::string emptyPictureText(const Volume& volume, const std::string& tooSmall) {
    const WorldBox world = worldBox(volume.box(), volume.worldFromIndex());
    return "picture: empty, for what can be seen of the volume lies outside of it, before the near "
           "plane, or " +
           tooSmall + "; the volume lies in the world from " + numberText(world.min) + " to " +
           numberText(world.max);
}

/// Returns the warning for a picture too faint to see.
inline std::string faintPictureText() {
    return "picture: looks empty, for no pixel is opaque to a half of 1/255: what can be seen of "
           "the volume is far thinner than a pixel, or hardly opaque; `cropIndex` shows a part of "
           "it larger, and `extinctionScale` makes it denser";
}

}  // namespace deltasplat
