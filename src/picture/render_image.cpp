// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "picture/plane_parts.h"
#include "picture/render_views.h"
#include "screen/clear_image.h"

namespace deltasplat {
namespace {

// Puts slabs together and shows them, view by view.
class ImageSink : public ViewSink {
  public:
    ImageSink(Image& image, KeptMemory& memory)
        : whole_(image), size_(image.size), memory_(memory) {}

    DrawnFor drawnFor() const override { return DrawnFor::kPixels; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl>, const PixelBox& part) override {
        group_.emplace(clearImage(part.size()));
        first_ = part.min;
    }
    void endGroup() override {
        putBehind(whole_, first_, *group_);
        group_.reset();
    }
    void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) override {
        planned.axis->packer ? showInParts(planned, stats, listener)
                             : show(planned, stats, listener);
    }
    bool isAnyBeyond(float least) const override {
        return deltasplat::isAnyBeyond(whole_.rgba, least);
    }

  private:
    // What of the picture is written.
    PicturePart part() {
        return group_ ? PicturePart(*group_, first_, size_) : PicturePart(whole_);
    }

    void show(const PlannedView& planned, RenderStats& stats, const Listener& listener) {
        const std::unique_ptr<const PictureView> view = planned.view(planned.axis);
        const SlabInput& slabs = view->slabs();
        const PicturePart all = part();
        std::vector<PlanePart> parts = planeParts(slabs, view->plane(), {all.first, all.last()});
        double gain = 0;
        showParts(parts, all, slabs.plane.isParallel(), [&](PlanePart& one, const PicturePart& to) {
            // Parts are of many sizes: memory that few can use would add up.
            if (parts.size() > 1) memory_.endPicture();
            const double share = 0.7 * double(&one - parts.data()) / double(parts.size());
            Layer merged =
                renderSlabs(slabs, std::move(one.slabs), stats,
                            partOf(listener, 0.2 + share, 0.2 + share + 0.7 / parts.size()));
            gain =
                std::max(gain, timedWarp(stats, [&] { return view->show(merged, to, one.whole); }));
        });
        listener.report(0.95);
        addBound(view->errorBound(), gain, stats);
    }

    // Makes words of a few slabs at a time, from the front on, and puts what they show behind what
    // is there.
    void showInParts(const PlannedView& planned, RenderStats& stats, const Listener& listener) {
        std::vector<SlabRange> parts = planned.axis->packer->parts();
        if (!planned.plan.view.frontToBack) std::reverse(parts.begin(), parts.end());
        std::unique_ptr<const PictureView> view;
        std::optional<Layer> merged;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto share = [&](double part) {
                return 0.2 + 0.7 * (double(i) + part) / double(parts.size());
            };
            // Words of one part go before those of the next come.
            view = nullptr;
            const Clock::time_point start = Clock::now();
            std::shared_ptr<const PreparedAxis> axis = planned.axis->withWords(parts[i]);
            stats.prepareSeconds += secondsSince(start);
            view = planned.view(std::move(axis));
            const SlabInput& input = view->slabs();
            std::vector<SeenSlab> seen = seenSlabs(input);
            if (!merged) {
                merged.emplace(PlaneBox{}, input.layout.channels, memory_);
                merged->setBox(reachOfAll(input, seen));
                merged->clearRest();
            }
            std::erase_if(seen, [&](const SeenSlab& one) {
                const auto number = one.slab - input.splat.deltas.slabs.data();
                return number < parts[i].first || number >= parts[i].last;
            });
            merged = renderSlabs(input, std::move(seen), stats,
                                 partOf(listener, share(0), share(1)), std::move(merged));
        }
        listener.report(0.95);
        const double gain = timedWarp(stats, [&] { return view->show(*merged, part()); });
        addBound(view->errorBound(), gain, stats);
    }

    template <typename Show>
    static double timedWarp(RenderStats& stats, const Show& show) {
        const Clock::time_point start = Clock::now();
        const double gain = show();
        stats.warpSeconds += secondsSince(start);
        return gain;
    }

    Image& whole_;
    glm::ivec2 size_;
    KeptMemory& memory_;
    std::optional<Image> group_;  // of the group in hand
    glm::ivec2 first_{0};         // pixel of the picture that it begins with
};

}  // namespace

RenderStats renderImage(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        Image& image, const Listener& listener) {
    ImageSink sink(image, memory);
    return renderViews(scene, camera, memory, sink, listener);
}

RenderStats PreparedScene::render(const Camera& camera, Image& image,
                                  const Listener& listener) const {
    requireSize(camera, image);
    // A parallel view writes every pixel.
    const bool isWritten =
        camera.projection == Projection::kOrtho && !scene().volume->empty() && !impl_->far;
    if (!isWritten) clearImage(image);
    const RenderStats stats = renderImage(*impl_, camera, *impl_->memory, image, listener);
    impl_->memory->endPicture();
    return stats;
}

Image PreparedScene::render(const Camera& camera, const Listener& listener) const {
    Image image = clearImage(camera.sizePixels);
    render(camera, image, listener);
    return image;
}

}  // namespace deltasplat
