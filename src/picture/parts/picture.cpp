// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/picture.h"

#include <algorithm>
#include <glm/common.hpp>
#include <memory>
#include <optional>

#include "base/default_floats.h"
#include "base/progress.h"
#include "picture/render_views.h"
#include "screen/clear_image.h"

namespace deltasplat {
namespace {

// Puts slabs together, and keeps what shows them.
class KeepSink : public ViewSink {
  public:
    explicit KeepSink(Picture::Impl& picture) : picture_(picture) {}

    DrawnFor drawnFor() const override { return DrawnFor::kSlabs; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl>, const PixelBox& part) override {
        group_ = part;
    }
    void endGroup() override { group_.reset(); }
    void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) override {
        const std::unique_ptr<const PictureView> view = planned.view(planned.axis);
        Layer merged =
            renderSlabs(view->slabs(), seenSlabs(view->slabs()), stats, partOf(listener, 0.2, 1));
        picture_.add(view->plane(), view->errorBound(), std::move(merged),
                     group_.value_or(picture_.whole()), group_.has_value());
    }
    bool isAnyBeyond(float least) const override {
        return std::any_of(picture_.views.begin(), picture_.views.end(), [&](const auto& view) {
            return deltasplat::isAnyBeyond(view.layer.values, least);
        });
    }

  private:
    Picture::Impl& picture_;
    std::optional<PixelBox> group_;
};

}  // namespace

Picture::Picture(const PreparedScene& scene, const Camera& camera, const Listener& listener)
    : impl_(std::make_unique<Impl>(camera)) {
    KeepSink sink(*impl_);
    impl_->stats = renderViews(scene.impl(), impl_->camera, impl_->memory, sink, listener);
}
Picture::Picture(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Picture::~Picture() = default;
Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;

const Camera& Picture::camera() const {
    return impl_->camera;
}

const RenderStats& Picture::stats() const {
    return impl_->stats;
}

void Picture::show(const PixelBox& part, Image& image) {
    const DefaultFloats floats;
    const glm::ivec2 size = impl_->camera.sizePixels;
    requirePart(part, size, image);
    const Clock::time_point start = Clock::now();
    clearImage(image);
    RenderStats& stats = impl_->stats;
    for (const Impl::View& view : impl_->views) {
        const PixelBox both{glm::max(part.min, view.part.min), glm::min(part.max, view.part.max)};
        if (both.empty()) continue;
        Image behind;
        if (view.coversOthers) behind = clearImage(both.size());
        Image& shown = view.coversOthers ? behind : image;
        const double gain = view.plane.showPart(view.layer, PicturePart(shown, both.min, size));
        if (view.coversOthers) putBehind(image, both.min - part.min, behind);
        addBound(view.bound, gain, stats);
    }
    const double seconds = secondsSince(start);
    stats.warpSeconds += seconds;
    stats.renderSeconds += seconds;
}

}  // namespace deltasplat
