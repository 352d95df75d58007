// SPDX-License-Identifier: Apache-2.0
#include "picture/extras/render_deep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/affine.h"
#include "base/kept_memory.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/render_deep.h"
#include "picture/picture_view.h"
#include "picture/prepared_axis.h"
#include "screen/clear_image.h"
#include "screen/deep_builder.h"

namespace deltasplat {

namespace {

// Numbers the samples of slices, independent of slabs.
class SampleNumbers {
  public:
    SampleNumbers(const Subdivision& parts, int slicesPerSample)
        : origin_(std::int64_t{parts.origin.x} * parts.slices),
          length_(std::max<std::int64_t>(std::int64_t{slicesPerSample} * parts.slices, 1)) {}

    std::int64_t of(int slice) const {
        const std::int64_t place = slice + origin_;
        return place / length_ - (place % length_ < 0);
    }
    // Last slice of the same sample, towards larger or smaller slices.
    std::int64_t last(int slice, bool towardsLarger) const {
        const std::int64_t first = of(slice) * length_ - origin_;
        return towardsLarger ? first + length_ - 1 : first;
    }

  private:
    std::int64_t origin_;
    std::int64_t length_;
};

void addPiece(const SeenSlab& piece, bool continues, std::vector<DeepCut>& cuts) {
    if (!continues) cuts.push_back({piece.firstSlice, piece.lastSlice, {}});
    DeepCut& cut = cuts.back();
    cut.firstSlice = std::min(cut.firstSlice, piece.firstSlice);
    cut.lastSlice = std::max(cut.lastSlice, piece.lastSlice);
    cut.slabs.push_back(piece);
}

void mergeBehind(Layer& front, const Layer& layer) {
    parallelForChunks(std::size_t(layer.box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            mergeRowBehind(front, layer, layer.box.min.y + int(row));
    });
}

// Position of a slice's front face in undivided slices, the same for all parts of a volume.
double faceBefore(int slice, const Subdivision& parts) {
    return parts.origin.x + double(slice) / parts.slices - 0.5;
}

}  // namespace

std::vector<DeepCut> cutInDepth(const std::vector<SeenSlab>& seen, bool frontToBack,
                                const Subdivision& parts, int slicesPerSample) {
    const SampleNumbers numbers(parts, slicesPerSample);
    std::vector<DeepCut> cuts;
    for (const SeenSlab& slab : seen) {
        int slice = frontToBack ? slab.firstSlice : slab.lastSlice;
        while (slice >= slab.firstSlice && slice <= slab.lastSlice) {
            const int last = int(std::clamp<std::int64_t>(numbers.last(slice, frontToBack),
                                                          slab.firstSlice, slab.lastSlice));
            const bool continues =
                !cuts.empty() && numbers.of(cuts.back().firstSlice) == numbers.of(slice);
            addPiece({slab.slab, std::min(slice, last), std::max(slice, last)}, continues, cuts);
            slice = frontToBack ? last + 1 : last - 1;
        }
    }
    return cuts;
}

void DeepSink::beginGroup(std::shared_ptr<const PreparedScene::Impl>, const PixelBox&) {
    group_.emplace(clearImage(image_.size));
    behind_.emplace(image_, stages_);
}

void DeepSink::endGroup() {
    putBehind(image_, {0, 0}, *group_);
    behind_.reset();
    group_.reset();
}

bool DeepSink::isAnyBeyond(float least) const {
    return deltasplat::isAnyBeyond(image_.rgba, least);
}

void DeepSink::take(const PlannedView& planned, RenderStats& stats, const Listener& listener) {
    DeepStages& stages = behind_ ? *behind_ : stages_;
    Image& flat = group_ ? *group_ : image_;
    const std::unique_ptr<const PictureView> view = planned.view(planned.axis);
    const SlabInput& input = view->slabs();
    const Subdivision& parts = planned.axis->parts();
    const bool frontToBack = input.plane.frontToBack();
    const std::vector<SeenSlab> seen = seenSlabs(input);
    const std::vector<DeepCut> cuts = cutInDepth(seen, frontToBack, parts, slicesPerSample_);
    const PlaneBox reach = reachOfAll(input, seen);
    // Showing may need a changed copy of the layer.
    const double layers = view->showChangesLayer() ? 2 : 1;
    requireMemory("layers of a deep picture", layers * layerBytes(reach, input.layout.channels));
    Layer merged(reach, input.layout.channels, planned.memory);
    stages.begin(std::make_shared<const SliceDepths>(planned.camera, view->worldFromSlices()));
    const Listener rendering = partOf(listener, 0.2, 0.95);
    double gain = 1;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const DeepCut& cut = cuts[i];
        const double count = double(cuts.size());
        const Layer layer = renderSlabs(
            input, cut.slabs, stats, partOf(rendering, double(i) / count, double(i + 1) / count));
        const Clock::time_point start = Clock::now();
        mergeBehind(merged, layer);
        stats.compositeSeconds += secondsSince(start);
        const Clock::time_point warpStart = Clock::now();
        if (view->showChangesLayer()) {
            Layer shown = merged;
            gain = std::max(gain, view->show(shown, PicturePart(flat)));
        } else {
            gain = std::max(gain, view->show(merged, PicturePart(flat)));
        }
        const double first = faceBefore(cut.firstSlice, parts);
        const double last = faceBefore(cut.lastSlice + 1, parts);
        stages.add(flat, frontToBack ? first : last, frontToBack ? last : first);
        stats.warpSeconds += secondsSince(warpStart);
    }
    addBound(view->errorBound(), gain, stats);
}

namespace {

// The flat picture, and its previous state.
constexpr double kBytesPerPixel = 32;

void checkSlices(int slices) {
    if (slices >= 1 && slices <= kMostSlicesPerSample) return;
    throw Error(ErrorCode::kUsage, "`slicesPerSample`", std::to_string(slices),
                "a whole number within 1.." + std::to_string(kMostSlicesPerSample));
}

std::string shortText(double number) {
    char text[32];
    return {text,
            std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

// Refuses parallel cameras within the volume; an eye does not see voxels behind it anyway.
void requireBefore(const Camera& camera, const Volume& volume) {
    if (camera.projection != Projection::kOrtho || volume.empty()) return;
    double nearest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(volume.box(), corner), 1);
        const glm::dvec3 away = glm::dvec3(volume.worldFromIndex() * index) - camera.eyeWorld();
        nearest = std::min(nearest, glm::dot(away, camera.direction));
    }
    // Half a voxel lies before its middle.
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 step(volume.worldFromIndex()[axis]);
        nearest -= 0.5 * std::abs(glm::dot(step, camera.direction));
    }
    // The suggested distance has six digits, so allow for its rounding.
    constexpr double kRounding = 1e-5;
    if (nearest >= -kRounding * std::abs(camera.targetDistanceWorld)) return;
    throw Error(ErrorCode::kUsage, "`distanceWorld`", numberText(camera.targetDistanceWorld),
                "at least " + shortText(camera.targetDistanceWorld - nearest) +
                    " for a deep picture, all of whose depths are beyond the camera");
}

RenderStats renderSamples(const PreparedScene::Impl& scene, const Camera& camera,
                          const DeepOptions& options, DeepImage& deep, Image& flat,
                          const Listener& listener) {
    DeepBuilder builder(camera.sizePixels, options.slicesPerSample);
    DeepSink sink(options.slicesPerSample, builder, flat);
    KeptMemory memory;
    RenderStats stats = renderViews(scene, camera, memory, sink, listener);
    const Clock::time_point start = Clock::now();
    memory.endPicture();
    deep = builder.finish();
    const double seconds = secondsSince(start);
    stats.warpSeconds += seconds;
    stats.renderSeconds += seconds;
    return stats;
}

}  // namespace

RenderResult renderDeep(const Volume& volume, const RenderOptions& options,
                        const DeepOptions& deepOptions, DeepImage& deep, const Listener& listener) {
    const DefaultFloats floats;
    checkSlices(deepOptions.slicesPerSample);
    if (options.mode != Mode::kComposite) {
        throw Error(ErrorCode::kUsage, "`mode`", modeName(options.mode),
                    "composite for a deep picture");
    }
    RenderResult result;
    const auto makePicture = [&](const Volume& seen) {
        result.camera = makeCamera(options.camera, seen);
        requireBefore(result.camera, seen);
        const glm::ivec2 size = result.camera.sizePixels;
        requireMemory("`sizePixels` " + dimsText(size), kBytesPerPixel * size.x * size.y);
        result.image = Image(size);
    };
    // Refuse bad cameras before there is work.
    if (options.optics.parts.empty()) makePicture(volume);
    // The volume outlives the scene.
    const std::shared_ptr<const Volume> borrowed(std::shared_ptr<const Volume>(), &volume);
    const Clock::time_point start = Clock::now();
    const PreparedScene::Impl scene({borrowed, options.optics}, options.splat, true);
    const double sceneSeconds = secondsSince(start);
    if (!options.optics.parts.empty()) makePicture(*scene.scene.volume);
    result.stats = renderSamples(scene, result.camera, deepOptions, deep, result.image, listener);
    result.stats.prepareSeconds += sceneSeconds;
    listener.report(1);
    return result;
}

RenderStats renderDeep(const PreparedScene& scene, const Camera& camera,
                       const DeepOptions& deepOptions, DeepImage& deep, Image& flat,
                       const Listener& listener) {
    const DefaultFloats floats;
    checkSlices(deepOptions.slicesPerSample);
    requireSize(camera, flat);
    requireBefore(camera, *scene.scene().volume);
    const glm::ivec2 size = camera.sizePixels;
    requireMemory("`sizePixels` " + dimsText(size), 0.5 * kBytesPerPixel * size.x * size.y);
    clearImage(flat);
    return renderSamples(scene.impl(), camera, deepOptions, deep, flat, listener);
}

}  // namespace deltasplat
