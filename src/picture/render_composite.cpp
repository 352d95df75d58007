// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/default_floats.h"
#include "base/kept_memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/prepared_scene.h"
#include "picture/empty_picture.h"
#include "picture/extras/render_deep.h"
#include "picture/far_groups.h"
#include "picture/kept_view.h"
#include "picture/plane_parts.h"
#include "screen/clear_image.h"
#include "screen/deep_builder.h"
#include "volume/box_voxels.h"

namespace deltasplat {
namespace {

// What is made: a picture, perhaps stage by stage as well, or behind another one; or views that it
// may be made of.
struct Wanted {
    Image* image = nullptr;
    glm::ivec2 first{0};  // pixel of the picture that the image begins with
    const DeepRequest* deep = nullptr;
    std::vector<KeptView>* views = nullptr;
};

// Of groups that lie far apart.
struct FarSeen {
    bool areAll = false;    // whether the picture shows all of them
    bool saysDots = false;  // whether it has been said that it shows no more than dots
};

// Opacity and light that nobody sees: an opacity of 8 bits would be 0.
constexpr float kHardlySeen = 0.5f / 255;

// Renders one picture, or the regions of one.
class CompositeRender {
  public:
    CompositeRender(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                    const Wanted& wanted, RenderStats& stats)
        : scene_(scene),
          volume_(*scene.scene.volume),
          options_(scene.options),
          camera_(camera),
          memory_(memory),
          wanted_(wanted),
          stats_(stats) {}

    void run(const Listener& listener) {
        const Clock::time_point start = Clock::now();
        plan_.emplace(scene_, camera_, wanted_.deep != nullptr, listener);
        stats_.prepareSeconds += secondsSince(start);
        const std::vector<Factorization>& views = plan_->views;
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto share = [&](double part) { return (double(i) + part) / views.size(); };
            runView(views[i], partOf(listener, share(0), share(1)));
        }
    }

    // Who reads an empty volume has been told so.
    // @param far  of groups that lie far apart
    void warnOfEmptyPicture(const FarSeen& far, const Listener& listener) const {
        if (volume_.empty() || isAnyBeyond(kHardlySeen)) return;
        if (isAnyBeyond(0)) {
            if (!far.saysDots) listener.warn(faintPictureText());
        } else if (stats_.visible == 0 && !isAnythingVisible(far, listener)) {
            const bool isSurface = scene_.scene.optics.surface.has_value();
            listener.warn(
                std::string("picture: empty, for ") +
                (isSurface ? "the surface encloses" : "transfer function and extinction show") +
                " none of the values " + numberText(volume_.valueMin) + " to " +
                numberText(volume_.valueMax));
        } else if (!far.saysDots) {
            listener.warn(emptyPictureText(volume_, "is far smaller than a pixel"));
        }
    }

  private:
    void runView(const Factorization& view, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        const bool isFlat = !wanted_.views && !wanted_.deep;
        std::shared_ptr<const PreparedAxis> axis =
            scene_.axis(view, plan_->sheets, listener, &camera_, isFlat);
        stats_.prepareSeconds += secondsSince(start);
        countIn(*axis);
        listener.report(0.2);
        if (volume_.empty()) return;
        if (axis->packer) return showInParts(view, *axis, listener);
        const Clock::time_point renderStart = Clock::now();
        auto picture = std::make_unique<const PictureView>(scene_, camera_, view, plan_->sheets,
                                                           std::move(axis), memory_);
        countIn(*picture);
        if (wanted_.views) {
            keep(std::move(picture), listener);
        } else {
            countBound(*picture,
                       wanted_.deep ? showDeep(*picture, listener) : showFlat(*picture, listener));
        }
        stats_.renderSeconds += secondsSince(renderStart);
    }

    // What of the picture is written.
    PicturePart part() const { return {*wanted_.image, wanted_.first, camera_.sizePixels}; }

    void keep(std::unique_ptr<const PictureView> picture, const Listener& listener) {
        Layer merged = renderSlabs(picture->slabs(), partOf(listener, 0.2, 1));
        picture->finish(merged);
        wanted_.views->push_back({std::move(picture), std::move(merged)});
    }

    double showFlat(const PictureView& picture, const Listener& listener) {
        const SlabInput& slabs = picture.slabs();
        const PicturePart all = part();
        std::vector<PlanePart> parts = planeParts(slabs, picture.plane(), {all.first, all.last()});
        double gain = 0;
        showParts(parts, all, slabs.plane.isParallel(), [&](PlanePart& one, const PicturePart& to) {
            // Parts are of many sizes: memory that few can use would add up.
            if (parts.size() > 1) memory_.endPicture();
            const double share = 0.7 * double(&one - parts.data()) / double(parts.size());
            Layer merged = renderSlabs(
                slabs, std::move(one.slabs),
                partOf(listener, 0.2 + share, 0.2 + share + 0.7 / double(parts.size())), {});
            gain = std::max(gain, timedWarp([&] { return picture.show(merged, to, one.whole); }));
        });
        listener.report(0.95);
        return gain;
    }

    // Makes words of a few slabs at a time, from the front on, and puts what they show behind what
    // is there.
    void showInParts(const Factorization& view, const PreparedAxis& planned,
                     const Listener& listener) {
        std::vector<SlabRange> parts = planned.packer->parts();
        if (!view.frontToBack) std::reverse(parts.begin(), parts.end());
        std::unique_ptr<const PictureView> picture;
        std::optional<Layer> merged;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto share = [&](double part) {
                return 0.2 + 0.7 * (double(i) + part) / double(parts.size());
            };
            // Words of one part go before those of the next come.
            picture = nullptr;
            const Clock::time_point start = Clock::now();
            std::shared_ptr<const PreparedAxis> axis = planned.withWords(parts[i]);
            stats_.prepareSeconds += secondsSince(start);
            const Clock::time_point renderStart = Clock::now();
            picture = std::make_unique<const PictureView>(scene_, camera_, view, plan_->sheets,
                                                          std::move(axis), memory_);
            const SlabInput& input = picture->slabs();
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
            merged = renderSlabs(input, std::move(seen), partOf(listener, share(0), share(1)),
                                 std::move(merged));
            stats_.renderSeconds += secondsSince(renderStart);
        }
        const Clock::time_point start = Clock::now();
        countIn(*picture);
        listener.report(0.95);
        countBound(*picture, timedWarp([&] { return picture->show(*merged, part()); }));
        stats_.renderSeconds += secondsSince(start);
    }

    template <typename Show>
    double timedWarp(const Show& show) {
        const Clock::time_point start = Clock::now();
        const double gain = show();
        stats_.warpSeconds += secondsSince(start);
        return gain;
    }

    double showDeep(const PictureView& picture, const Listener& listener) {
        const DeepViewResult result =
            renderDeepView(picture, wanted_.deep->slicesPerSample, memory_, wanted_.deep->stages,
                           *wanted_.image, partOf(listener, 0.2, 0.95));
        stats_.compositeSeconds += result.slabSeconds * result.compositeShare;
        stats_.splatSeconds += result.slabSeconds * (1 - result.compositeShare);
        stats_.warpSeconds += result.warpSeconds;
        return result.gain;
    }

    // Whether a picture, or what it would be made of, has anything beyond a value.
    bool isAnyBeyond(float least) const {
        const auto isAnyOf = [least](const auto& values) {
            const auto isSeen = [least](float value) { return std::abs(value) > least; };
            // Most pictures show something in the middle.
            const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
            return std::any_of(middle, values.end(), isSeen) ||
                   std::any_of(values.begin(), middle, isSeen);
        };
        if (wanted_.image) return isAnyOf(wanted_.image->rgba);
        return std::any_of(wanted_.views->begin(), wanted_.views->end(),
                           [&](const KeptView& view) { return isAnyOf(view.layer.values); });
    }

    // Whether any voxel can be seen from elsewhere, of a picture whose regions see none.
    bool isAnythingVisible(const FarSeen& far, const Listener& listener) const {
        // Groups that are not seen have not been asked.
        if (scene_.far) return !far.areAll;
        const Factorization& view = plan_->views.front();
        return view.eye &&
               scene_.axis(view, plan_->sheets, listener, nullptr, true)->deltas().visible() > 0;
    }

    void countIn(const PreparedAxis& axis) {
        stats_.between = axis.parts.slices - 1;
        stats_.parts = axis.parts.voxels();
        stats_.joined = axis.parts.joined;
        stats_.stamps += axis.stamps(options_.method);
        // Of regions, that which sees most stands for all.
        if (stats_.slices > 0 && axis.deltas().visible() <= stats_.visible) return;
        stats_.sliceAxis = axis.sliceAxis;
        const IndexBox& box = axis.deltas().box;
        stats_.slices = box.dims().x;
        stats_.voxels = voxelsOf(box);
        stats_.visible = axis.deltas().visible();
        stats_.deltas = axis.deltas().deltas();
        stats_.slabs = int(axis.deltas().slabs.size());
    }

    void countIn(const PictureView& picture) {
        const Footprint& footprint = picture.footprint();
        stats_.resolution = footprint.resolution * picture.axis().parts.per().y;
        stats_.footprint = std::max(stats_.footprint, footprint.width);
    }

    void countBound(const PictureView& picture, double gain) {
        const ErrorBound bound = picture.errorBound();
        stats_.errorBoundColor = std::max(stats_.errorBoundColor, bound.color * gain);
        stats_.errorBoundAlpha = std::max(stats_.errorBoundAlpha, bound.alpha * gain);
    }

    Layer renderSlabs(const SlabInput& input, const Listener& listener) {
        return renderSlabs(input, seenSlabs(input), listener, {});
    }

    Layer renderSlabs(const SlabInput& input, std::vector<SeenSlab> seen, const Listener& listener,
                      std::optional<Layer> front) {
        const Clock::time_point start = Clock::now();
        SlabRenderer slabs(input, std::move(seen), listener, std::move(front));
        slabs.run();
        const double slabSeconds = secondsSince(start);
        Layer merged = slabs.merge();
        const double splatSeconds = slabSeconds * (1 - slabs.compositeShare());
        stats_.splatSeconds += splatSeconds;
        stats_.compositeSeconds += secondsSince(start) - splatSeconds;
        return merged;
    }

    const PreparedScene::Impl& scene_;
    const Volume& volume_;
    const SplatOptions& options_;
    const Camera& camera_;
    KeptMemory& memory_;
    const Wanted& wanted_;
    RenderStats& stats_;
    std::optional<ViewPlan> plan_;
};

// Renders groups of voxels that lie far apart, each behind those before it.
class FarRender {
  public:
    FarRender(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
              const Wanted& wanted, RenderStats& stats)
        : scene_(scene), camera_(camera), memory_(memory), wanted_(wanted), stats_(stats) {}

    FarSeen run(const Listener& listener) {
        const FarGroups& far = *scene_.far;
        if (wanted_.image) clearImage(*wanted_.image);
        const std::vector<std::size_t> order = far.frontToBack(camera_);
        const double count = double(order.size());
        bool areAll = true;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const FarGroups::Seen seen = far.seenBy(camera_, order[i]);
            areAll = areAll && !seen.isNothing();
            if (seen.isNothing()) continue;
            renderGroup(std::make_shared<const PreparedScene::Impl>(scene_, order[i]), seen.part,
                        partOf(listener, double(i) / count, double(i + 1) / count));
        }
        return {areAll, far.warnOfDots(camera_, listener)};
    }

  private:
    void renderGroup(const std::shared_ptr<const PreparedScene::Impl>& group, const PixelBox& part,
                     const Listener& listener) {
        RenderStats stats = stats_;
        stats.visible = stats.deltas = stats.voxels = 0;
        stats.slices = 0;
        const auto renderAs = [&](const Wanted& wanted) {
            CompositeRender(*group, camera_, memory_, wanted, stats).run(listener);
        };
        if (wanted_.views) {
            const std::size_t before = wanted_.views->size();
            renderAs({.views = wanted_.views});
            for (std::size_t i = before; i < wanted_.views->size(); ++i) {
                (*wanted_.views)[i].group = group;
                (*wanted_.views)[i].part = part;
            }
        } else if (wanted_.deep) {
            Image flat = clearImage(camera_.sizePixels);
            StagesBehind stages(*wanted_.image, wanted_.deep->stages);
            const DeepRequest request{wanted_.deep->slicesPerSample, stages};
            renderAs({.image = &flat, .deep = &request});
            putBehind(*wanted_.image, {0, 0}, flat);
        } else {
            Image image = clearImage(part.size());
            renderAs({.image = &image, .first = part.min});
            putBehind(*wanted_.image, part.min, image);
        }
        countIn(stats);
    }

    // Counts are those of all groups.
    void countIn(RenderStats stats) {
        stats.visible += stats_.visible;
        stats.deltas += stats_.deltas;
        stats.voxels += stats_.voxels;
        stats.slices = std::max(stats.slices, stats_.slices);
        stats_ = stats;
    }

    const PreparedScene::Impl& scene_;
    const Camera& camera_;
    KeptMemory& memory_;
    const Wanted& wanted_;
    RenderStats& stats_;
};

RenderStats renderAs(const Wanted& wanted, const PreparedScene::Impl& scene, const Camera& camera,
                     KeptMemory& memory, const Listener& listener) {
    const DefaultFloats floats;
    RenderStats stats;
    stats.mode = Mode::kComposite;
    stats.method = scene.options.method;
    stats.tolerance = scene.options.tolerance;
    CompositeRender render(scene, camera, memory, wanted, stats);
    FarSeen far;
    if (scene.far) {
        far = FarRender(scene, camera, memory, wanted, stats).run(listener);
    } else {
        render.run(listener);
    }
    render.warnOfEmptyPicture(far, listener);
    return stats;
}

}  // namespace

struct Renderer::Impl {
    KeptMemory memory;
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

RenderStats Renderer::render(const PreparedScene& scene, const Camera& camera, Image& image,
                             const Listener& listener) {
    requireSize(camera, image);
    // A parallel view writes every pixel.
    const bool isWritten = camera.projection == Projection::kOrtho &&
                           !scene.scene().volume->empty() && !scene.impl().far;
    if (!isWritten) clearImage(image);
    const RenderStats stats = renderComposite(scene.impl(), camera, impl_->memory, image, listener);
    impl_->memory.endPicture();
    return stats;
}

RenderStats renderComposite(const PreparedScene& scene, const Camera& camera, Image& image,
                            const Listener& listener) {
    return Renderer().render(scene, camera, image, listener);
}

RenderStats renderComposite(const PreparedScene::Impl& scene, const Camera& camera,
                            KeptMemory& memory, Image& image, const Listener& listener,
                            const DeepRequest* deep) {
    return renderAs({.image = &image, .deep = deep}, scene, camera, memory, listener);
}

RenderStats renderKept(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                       std::vector<KeptView>& views, const Listener& listener) {
    return renderAs({.views = &views}, scene, camera, memory, listener);
}

}  // namespace deltasplat
