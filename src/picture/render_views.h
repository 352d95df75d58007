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

/// A view of a picture as it comes: its plan and its words.
struct PlannedView {
    const PreparedScene::Impl& scene;  ///< of all voxels, or of a group that lies far from others
    const Camera& camera;
    const ViewPlan& plan;
    /// With a packer only for DrawnFor::kPixels: words then come by PreparedAxis::withWords.
    std::shared_ptr<const PreparedAxis> axis;
    KeptMemory& memory;

    std::unique_ptr<const PictureView> view(std::shared_ptr<const PreparedAxis> words) const {
        return std::make_unique<const PictureView>(scene, camera, plan, std::move(words), memory);
    }
};

/// Takes the views of a picture, those in front first, and makes of them what it is for.
class ViewSink {
  public:
    virtual ~ViewSink() = default;

    virtual DrawnFor drawnFor() const = 0;
    /// Views up to endGroup() are of a group of voxels that lies far apart from others, behind
    /// those of groups before.
    /// @param part  pixels that may show something of it
    virtual void beginGroup(std::shared_ptr<const PreparedScene::Impl> group,
                            const PixelBox& part) = 0;
    virtual void endGroup() = 0;
    /// @param stats  gets the sink's times, but for `renderSeconds`, and its error bounds
    virtual void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) = 0;
    /// Returns whether anything of what was made is larger than a value.
    virtual bool isAnyBeyond(float least) const = 0;
};

/// Plans a picture, makes the words of its views and gives them to a sink, one after the other.
/// Warns where what comes of it shows nothing.
/// @param camera,memory  must outlive what the sink keeps
RenderStats renderViews(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        ViewSink& sink, const Listener& listener);

/// Renders a picture.
/// @param image  of the camera's size, clear
RenderStats renderImage(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        Image& image, const Listener& listener);

/// Renders all slabs of a view, or some of them, and puts them together.
/// @param front  what is before them, if anything
Layer renderSlabs(const SlabInput& input, std::vector<SeenSlab> seen, RenderStats& stats,
                  const Listener& listener, std::optional<Layer> front = {});

/// Notes a view's error bounds.
/// @param gain  the most that showing it can enlarge a difference of layers
void addBound(const ErrorBound& bound, double gain, RenderStats& stats);

/// Returns whether any number is farther from 0 than `least`.
bool isAnyBeyond(std::span<const float> values, float least);

/// Returns what is said of a picture that shows nothing of a volume though it has something to
/// show.
/// @param tooSmall  what of it may also be the reason: "is far smaller than a pixel"
inline std::string emptyPictureText(const Volume& volume, const std::string& tooSmall) {
    const WorldBox world = worldBox(volume.box, volume.worldFromIndex);
    return "picture: empty, for what can be seen of the volume lies outside of it, before the near "
           "plane, or " +
           tooSmall + "; the volume lies in the world from " + numberText(world.min) + " to " +
           numberText(world.max);
}

/// Returns what is said of a picture that shows something that nobody will see.
inline std::string faintPictureText() {
    return "picture: looks empty, for no pixel is opaque to a half of 1/255: what can be seen of "
           "the volume is far thinner than a pixel, or hardly opaque; `cropIndex` shows a part of "
           "it larger, and `extinctionScale` makes it denser";
}

}  // namespace deltasplat
