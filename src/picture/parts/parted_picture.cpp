// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/parted_picture.h"

#include <algorithm>
#include <glm/common.hpp>
#include <vector>

#include "base/default_floats.h"
#include "base/kept_memory.h"
#include "base/progress.h"
#include "picture/kept_view.h"
#include "picture/plane_view.h"
#include "screen/clear_image.h"

namespace deltasplat {
struct PartedPicture::Impl {
    Impl(const PreparedScene& ofScene, const Camera& ofCamera) : scene(ofScene), camera(ofCamera) {}

    PreparedScene scene;
    Camera camera;
    KeptMemory memory;
    std::vector<KeptView> views;
    RenderStats stats;
};

PartedPicture::PartedPicture(const PreparedScene& scene, const Camera& camera,
                             const Listener& listener)
    : impl_(std::make_unique<Impl>(scene, camera)) {
    const DefaultFloats floats;
    impl_->stats =
        renderKept(impl_->scene.impl(), impl_->camera, impl_->memory, impl_->views, listener);
}
PartedPicture::~PartedPicture() = default;
PartedPicture::PartedPicture(PartedPicture&&) noexcept = default;
PartedPicture& PartedPicture::operator=(PartedPicture&&) noexcept = default;

const Camera& PartedPicture::camera() const {
    return impl_->camera;
}

const RenderStats& PartedPicture::stats() const {
    return impl_->stats;
}

void PartedPicture::show(const PixelBox& part, Image& image) {
    const DefaultFloats floats;
    requirePart(part, impl_->camera.sizePixels, image);
    const Clock::time_point start = Clock::now();
    clearImage(image);
    RenderStats& stats = impl_->stats;
    const glm::ivec2 size = impl_->camera.sizePixels;
    for (const KeptView& view : impl_->views) {
        const auto showIn = [&](Image& shown, glm::ivec2 first) {
            return view.picture->showPart(view.layer, PicturePart(shown, first, size));
        };
        double gain = 0;
        if (!view.group) {
            gain = showIn(image, part.min);
        } else {
            const PixelBox both{glm::max(part.min, view.part.min),
                                glm::min(part.max, view.part.max)};
            if (both.empty()) continue;
            Image behind = clearImage(both.size());
            gain = showIn(behind, both.min);
            putBehind(image, both.min - part.min, behind);
        }
        const ErrorBound bound = view.picture->errorBound();
        stats.errorBoundColor = std::max(stats.errorBoundColor, bound.color * gain);
        stats.errorBoundAlpha = std::max(stats.errorBoundAlpha, bound.alpha * gain);
    }
    const double seconds = secondsSince(start);
    stats.warpSeconds += seconds;
    stats.renderSeconds += seconds;
}

}  // namespace deltasplat
