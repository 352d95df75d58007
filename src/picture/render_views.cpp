// SPDX-License-Identifier: Apache-2.0
#include "picture/render_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/presets.h"
#include "deltasplat/render.h"
#include "picture/far_groups.h"
#include "picture/rays/ray_render.h"
#include "screen/clear_image.h"
#include "volume/code_math.h"

namespace deltasplat {

namespace {

// Opacity and light that nobody sees: 0 when rounded to 8 bits.
constexpr float kHardlySeen = 0.5f / 255;

class ViewsRender {
  public:
    ViewsRender(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                ViewSink& sink)
        : scene_(scene), camera_(camera), memory_(memory), sink_(sink) {
        stats_.mode = Mode::kComposite;
        stats_.method = scene.options.method;
        stats_.tolerance = scene.options.tolerance;
    }

    RenderStats run(const Listener& listener) {
        if (scene_.far) {
            runGroups(listener);
        } else {
            runScene(scene_, listener);
        }
        warnOfEmptyPicture(listener);
        return stats_;
    }

  private:
    void runScene(const PreparedScene::Impl& scene, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        plan_ = planPicture(scene, camera_, sink_.drawnFor(), listener);
        stats_.prepareSeconds += secondsSince(start);
        const double count = double(plan_.views.size());
        for (std::size_t i = 0; i < plan_.views.size(); ++i) {
            runView(scene, plan_.views[i],
                    partOf(listener, double(i) / count, double(i + 1) / count));
        }
    }

    void runView(const PreparedScene::Impl& scene, const ViewPlan& plan, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        std::shared_ptr<const PreparedAxis> axis = scene.axis(plan.axis, listener);
        stats_.prepareSeconds += secondsSince(start);
        countIn(*axis);
        listener.report(0.2);
        if (scene.scene.volume->empty()) return;
        stats_.resolution = plan.footprint.resolution * axis->parts().per().y;
        stats_.footprint = std::max(stats_.footprint, plan.footprint.width);
        const Clock::time_point renderStart = Clock::now();
        const double prepared = stats_.prepareSeconds;
        sink_.take({scene, camera_, plan, std::move(axis), memory_}, stats_, listener);
        stats_.renderSeconds += secondsSince(renderStart) - (stats_.prepareSeconds - prepared);
    }

    // Renders far groups from front to back.
    void runGroups(const Listener& listener) {
        const FarGroups& far = *scene_.far;
        const std::vector<std::size_t> order = far.frontToBack(camera_);
        const double count = double(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            const FarGroups::Seen seen = far.seenBy(camera_, order[i]);
            showsAllGroups_ = showsAllGroups_ && !seen.isNothing();
            if (seen.isNothing()) continue;
            const auto group = std::make_shared<const PreparedScene::Impl>(scene_, order[i]);
            // The stats count all groups.
            const RenderStats before = stats_;
            stats_.visible = stats_.deltas = stats_.voxels = 0;
            stats_.slices = 0;
            sink_.beginGroup(group, seen.part);
            runScene(*group, partOf(listener, double(i) / count, double(i + 1) / count));
            sink_.endGroup();
            stats_.visible += before.visible;
            stats_.deltas += before.deltas;
            stats_.voxels += before.voxels;
            stats_.slices = std::max(stats_.slices, before.slices);
        }
        saysDots_ = far.warnOfDots(camera_, listener);
    }

    void countIn(const PreparedAxis& axis) {
        stats_.between = axis.parts().slices - 1;
        stats_.parts = axis.parts().voxels();
        stats_.joined = axis.parts().joined;
        stats_.stamps += axis.stamps(scene_.options.method);
        // The region with most visible voxels stands for all.
        if (stats_.slices > 0 && axis.deltas().visible() <= stats_.visible) return;
        stats_.sliceAxis = axis.sliceAxis();
        const IndexBox& box = axis.deltas().box;
        stats_.slices = box.dims().x;
        stats_.voxels = voxelsOf(box);
        stats_.visible = axis.deltas().visible();
        stats_.deltas = axis.deltas().deltas();
        stats_.slabs = int(axis.deltas().slabs.size());
    }

    // Readers have already warned of an empty volume.
    void warnOfEmptyPicture(const Listener& listener) const {
        const Volume& volume = *scene_.scene.volume;
        if (volume.empty() || sink_.isAnyBeyond(kHardlySeen)) return;
        if (sink_.isAnyBeyond(0)) {
            if (!saysDots_) listener.warn(faintPictureText());
        } else if (stats_.visible == 0 && !isAnythingVisible(listener)) {
            const bool isSurface = scene_.scene.optics.surface.has_value();
            listener.warn(
                std::string("picture: empty, for ") +
                (isSurface ? "the surface encloses" : "transfer function and extinction show") +
                " none of the values " + numberText(volume.valueMin()) + " to " +
                numberText(volume.valueMax()));
        } else if (!saysDots_) {
            listener.warn(emptyPictureText(volume, "is far smaller than a pixel"));
        }
    }

    // Whether any voxel is visible from elsewhere, if the picture's regions show none.
    bool isAnythingVisible(const Listener& listener) const {
        // Invisible groups were not examined.
        if (scene_.far) return !showsAllGroups_;
        AxisPlan all = plan_.views.front().axis;
        all.seen.reset();
        all.mayBeParted = scene_.isForOne;
        return plan_.views.front().view.eye && scene_.axis(all, listener)->deltas().visible() > 0;
    }

    const PreparedScene::Impl& scene_;
    const Camera& camera_;
    KeptMemory& memory_;
    ViewSink& sink_;
    RenderStats stats_;
    DrawPlan plan_;
    bool showsAllGroups_ = true;
    bool saysDots_ = false;  // whether warnOfDots() has warned
};

}  // namespace

RenderStats renderViews(const PreparedScene::Impl& scene, const Camera& camera, KeptMemory& memory,
                        ViewSink& sink, const Listener& listener) {
    const DefaultFloats floats;
    return ViewsRender(scene, camera, memory, sink).run(listener);
}

Layer renderSlabs(const SlabInput& input, std::vector<SeenSlab> seen, RenderStats& stats,
                  const Listener& listener, std::optional<Layer> front) {
    const Clock::time_point start = Clock::now();
    SlabRenderer slabs(input, std::move(seen), listener, std::move(front));
    slabs.run();
    const double slabSeconds = secondsSince(start);
    Layer merged = slabs.merge();
    const double splatSeconds = slabSeconds * (1 - slabs.compositeShare());
    stats.splatSeconds += splatSeconds;
    stats.compositeSeconds += secondsSince(start) - splatSeconds;
    return merged;
}

void addBound(const ErrorBound& bound, double gain, RenderStats& stats) {
    stats.errorBoundColor = std::max(stats.errorBoundColor, bound.color * gain);
    stats.errorBoundAlpha = std::max(stats.errorBoundAlpha, bound.alpha * gain);
}

bool isAnyBeyond(std::span<const float> values, float least) {
    const auto isSeen = [least](float value) { return std::abs(value) > least; };
    // Most pictures show something in the middle.
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    return std::any_of(middle, values.end(), isSeen) || std::any_of(values.begin(), middle, isSeen);
}

namespace {

// The picture and its encoding (measured: 41 bytes for a float .exr).
constexpr double kBytesPerPixel = 48;

void requireImageMemory(glm::ivec2 size) {
    requireMemory("`sizePixels` " + dimsText(size), kBytesPerPixel * size.x * size.y);
}

}  // namespace

std::string methodName(Method method) {
    return enumName(method, {"auto", "delta", "sparse", "traditional"});
}

std::string pictureFilterName(PictureFilter filter) {
    return enumName(filter, {"catmull-rom", "mitchell", "gauss", "box"});
}

std::string modeName(Mode mode) {
    return enumName(mode, {"composite", "xray", "mip", "min", "average", "drr"});
}

RenderResult render(const Volume& volume, const RenderOptions& options, const Listener& listener) {
    const DefaultFloats floats;
    RenderResult result;
    const auto makePicture = [&](const Volume& seen) {
        result.camera = makeCamera(options.camera, seen);
        requireImageMemory(result.camera.sizePixels);
        result.image = clearImage(result.camera.sizePixels);
    };
    RenderStats& stats = result.stats;
    stats.voxels = voxelsOf(volume.box());
    stats.mode = options.mode;
    stats.method = options.splat.method;
    if (options.mode == Mode::kComposite) {
        // Refuse bad cameras before there is work.
        if (options.optics.parts.empty()) makePicture(volume);
        // The volume outlives the scene.
        const std::shared_ptr<const Volume> borrowed(std::shared_ptr<const Volume>(), &volume);
        const Clock::time_point start = Clock::now();
        const PreparedScene::Impl scene({borrowed, options.optics}, options.splat, true);
        const double sceneSeconds = secondsSince(start);
        if (!options.optics.parts.empty()) makePicture(*scene.scene.volume);
        KeptMemory memory;
        stats = renderImage(scene, result.camera, memory, result.image, listener);
        stats.prepareSeconds += sceneSeconds;
    } else {
        makePicture(volume);
        renderRays(volume, options, listener, result);
    }
    listener.report(1);
    return result;
}

RenderResult render(const Volume& volume, const Listener& listener) {
    RenderOptions options;
    options.optics = defaultOptics(volume);
    options.splat.mostJoined = kMostJoined;
    return render(volume, options, listener);
}

}  // namespace deltasplat
