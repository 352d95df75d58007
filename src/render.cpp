// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <utility>

#include "composite/compositor.h"
#include "composite/layer_fold.h"
#include "deltasplat/threads.h"
#include "image/warp.h"
#include "memory.h"
#include "optics/hold_rule.h"
#include "parallel.h"
#include "splat/splatter.h"
#include "stopwatch.h"

namespace deltasplat {
namespace {

Encoding encodingOf(Method method) {
    switch (method) {
        case Method::kAuto:
            return Encoding::kSmaller;
        case Method::kDelta:
            return Encoding::kChanges;
        default:
            return Encoding::kWhole;
    }
}

// The picture itself, and what encoding it takes besides (measured: 41 bytes for a float .exr).
constexpr double kBytesPerPixel = 48;

void requireImageMemory(glm::ivec2 size) {
    requireMemory("--size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                  kBytesPerPixel * size.x * size.y);
}

// A factorization in the sheets' axes: they run along v.
struct PlaneView {
    explicit PlaneView(const Factorization& view)
        : frontToBack(view.frontToBack),
          shiftPerSlice(view.shiftPerSlice.y, view.shiftPerSlice.x),
          planeFromPixel(glm::dmat3(0, 1, 0, 1, 0, 0, 0, 0, 1) * view.baseFromPixel) {}

    bool frontToBack;
    glm::dvec2 shiftPerSlice;
    glm::dmat3 planeFromPixel;
};

// Below this opacity a slice, two sheet pixels a voxel show nothing that one does not: measured on
// smoke, the pictures agree to 56 dB or better (docs/decisions.md).
constexpr double kThinSlice = 0.25;

// Where the screen asks for two sheet pixels a voxel, what is thin gets one.
int sheetResolution(const Factorization& view, const ClassTable& classes,
                    const RenderOptions& options) {
    const bool thin = classes.scale.a * ClassTable::kMax <= kThinSlice;
    return !options.resolution && view.resolution == 2 && thin ? 1 : view.resolution;
}

// What the slabs share, and where their results go.
class SlabRenderer {
  public:
    SlabRenderer(const SplatInput& input, const PlaneView& view, const Listener& listener)
        : input_(input),
          view_(view),
          layout_(input.layout),
          listener_(listener),
          scale_(input.classes.scale / double(Footprint::kOne)),
          layers_(input.deltas.slabs.size(), reachOfAll(), layout_.channels) {}

    // Renders all slabs, from the front on.
    void run() {
        const std::vector<Slab>& slabs = input_.deltas.slabs;
        const auto workers = std::min<std::size_t>(std::size_t(threadCount()), slabs.size());
        parallelFor(workers, [&](std::size_t) {
            Splatter splatter(input_);
            for (std::size_t i = next_++; i < slabs.size(); i = next_++) {
                renderSlab(i, slabs[view_.frontToBack ? i : slabs.size() - 1 - i], splatter);
            }
        });
    }
    // Returns what the slabs look like together.
    Layer merge() { return layers_.finish(); }

    std::uint64_t stamps() const { return stamps_; }
    // The share of the slabs' time that went into compositing, 0..1.
    double compositeShare() const {
        return slabSeconds_ > 0 ? compositeSeconds_ / slabSeconds_ : 0;
    }

  private:
    PlaneBox reachOfAll() const {
        const IndexBox& box = input_.deltas.box;
        return reachOf(layout_, view_.shiftPerSlice, box.min.x, box.dims().x);
    }

    void renderSlab(std::size_t number, const Slab& slab, Splatter& splatter) {
        const Clock::time_point start = Clock::now();
        double compositeSeconds = 0;
        Compositor compositor(scale_, view_.frontToBack);
        Layer layer =
            layers_.take(reachOf(layout_, view_.shiftPerSlice, slab.firstSlice, slab.sliceCount));
        const std::uint64_t stamps = splatter.run(slab, [&](int slice, const Sheet& filled) {
            const Clock::time_point before = Clock::now();
            const SheetShift shift = shiftOf(layout_, view_.shiftPerSlice, slice);
            compositor.composite(filled, shift, layer);
            compositeSeconds += secondsSince(before);
        });
        const Clock::time_point before = Clock::now();
        layers_.add(number, std::move(layer));
        compositeSeconds += secondsSince(before);
        count(slab, stamps, compositeSeconds, secondsSince(start));
    }

    void count(const Slab& slab, std::uint64_t stamps, double compositeSeconds,
               double slabSeconds) {
        const std::lock_guard lock(mutex_);
        stamps_ += stamps;
        compositeSeconds_ += compositeSeconds;
        slabSeconds_ += slabSeconds;
        slicesDone_ += slab.sliceCount;
        listener_.report(0.2 + 0.7 * slicesDone_ / input_.deltas.box.dims().x);
    }

    const SplatInput& input_;
    const PlaneView& view_;
    const SheetLayout& layout_;
    const Listener& listener_;
    glm::vec4 scale_;
    LayerFold layers_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;  // guards all below
    std::uint64_t stamps_ = 0;
    double compositeSeconds_ = 0;
    double slabSeconds_ = 0;
    int slicesDone_ = 0;
};

// Maps picture positions to base plane pixels: r a voxel, counted from the layout's first voxel and
// slice.
glm::dmat3 planeFromPixel(const PlaneView& view, const SheetLayout& layout) {
    const glm::dvec2 origin =
        glm::dvec2(layout.firstVoxel) + double(layout.firstSlice) * view.shiftPerSlice;
    glm::dmat3 relative = view.planeFromPixel;
    relative[2] -= glm::dvec3(origin, 0);
    const double r = layout.resolution;
    const double offset = layout.offsetPixels;
    return glm::dmat3(r, 0, 0, 0, r, 0, -offset, -offset, 1) * relative;
}

Raster rasterOf(const Layer& layer, const ClassTable& classes) {
    Raster raster{layer.box.min, layer.box.size(), layer.values.data(), layer.channels};
    // Of one colour, every channel is a fixed share of the opacity.
    if (classes.oneColor) raster.color = glm::dvec3(classes.scale) / classes.scale.a;
    return raster;
}

// What all slabs together take: splatters for each thread, layers, and the merged one.
void requireSlabMemory(const PackedDeltas& deltas, const PlaneView& view,
                       const SheetLayout& layout) {
    double bytes =
        Splatter::bytes(layout) * std::min<double>(threadCount(), double(deltas.slabs.size()));
    const auto layerBytes = [&](int firstSlice, int sliceCount) {
        const glm::dvec2 size = reachOf(layout, view.shiftPerSlice, firstSlice, sliceCount).size();
        return sizeof(float) * layout.channels * size.x * size.y;
    };
    for (const Slab& slab : deltas.slabs) bytes += layerBytes(slab.firstSlice, slab.sliceCount);
    bytes += layerBytes(deltas.box.min.x, deltas.box.dims().x);
    requireMemory("sheets and layers at " + std::to_string(layout.resolution) + " pixels a voxel",
                  bytes);
}

void renderDeltas(const PackedDeltas& deltas, const ClassTable& classes, const Factorization& view,
                  const RenderOptions& options, const Listener& listener, RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const PlaneView planeView(view);
    const int resolution = sheetResolution(view, classes, options);
    const Footprint footprint =
        makeFootprint(options.sigma.value_or(defaultSigma(resolution)), planeView.shiftPerSlice,
                      resolution, options.footprintWidth);
    const SheetLayout layout = layoutSheet(deltas.box, footprint, classes.oneColor ? 1 : 4);
    requireSlabMemory(deltas, planeView, layout);
    const SplatInput input{deltas, classes, footprint, layout,
                           options.method == Method::kTraditional};
    SlabRenderer slabs(input, planeView, listener);
    slabs.run();
    const double slabSeconds = secondsSince(start);

    const Layer merged = slabs.merge();
    const double mergedSeconds = secondsSince(start);
    listener.report(0.95);

    const glm::dmat3 map = planeFromPixel(planeView, layout);
    warp(rasterOf(merged, classes), map, result.image);

    RenderStats& stats = result.stats;
    stats.stamps = slabs.stamps();
    const ErrorBound bound = errorBound(classes, options.tolerance);
    stats.errorBoundColor = bound.color * warpGain(map);
    stats.errorBoundAlpha = bound.alpha * warpGain(map);
    stats.resolution = resolution;
    stats.footprint = footprint.width;
    stats.renderSeconds = secondsSince(start);
    stats.splatSeconds = slabSeconds * (1 - slabs.compositeShare());
    stats.compositeSeconds = mergedSeconds - stats.splatSeconds;
    stats.warpSeconds = stats.renderSeconds - mergedSeconds;
}

}  // namespace

std::string methodName(Method method) {
    switch (method) {
        case Method::kAuto:
            return "auto";
        case Method::kDelta:
            return "delta";
        case Method::kSparse:
            return "sparse";
        case Method::kTraditional:
            return "traditional";
    }
    return "auto";
}

RenderResult render(const Volume& volume, const RenderOptions& options, const Listener& listener) {
    const Clock::time_point start = Clock::now();
    RenderResult result;
    result.camera = makeCamera(options.camera, volume.box, volume.worldFromIndex);
    requireImageMemory(result.camera.sizePixels);
    result.image = Image(result.camera.sizePixels);
    const Factorization view = factorize(result.camera, volume.worldFromIndex, options.resolution);

    const ClassTable classes = classify(volume, options.optics, view.sliceStepWorld);
    listener.report(0.05);
    const PackedDeltas deltas =
        packDeltas(volume, {view.sliceAxis, encodingOf(options.method), classes.classOfSlot,
                            holdRule(volume, classes, options.tolerance)});
    listener.report(0.2);

    RenderStats& stats = result.stats;
    stats.method = options.method;
    stats.tolerance = options.tolerance;
    stats.voxels = std::uint64_t(volume.box.voxels());
    stats.visible = deltas.visible();
    stats.deltas = deltas.deltas();
    stats.slices = deltas.box.dims().x;
    stats.slabs = int(deltas.slabs.size());
    stats.sliceAxis = view.sliceAxis;
    stats.prepareSeconds = secondsSince(start);
    if (!volume.empty()) renderDeltas(deltas, classes, view, options, listener, result);
    listener.report(1);
    return result;
}

}  // namespace deltasplat
