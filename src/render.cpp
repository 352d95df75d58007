// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "composite/layer.h"
#include "deltasplat/threads.h"
#include "image/warp.h"
#include "memory.h"
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

// What the slabs share, and where their results go.
class SlabRenderer {
  public:
    SlabRenderer(const SplatInput& input, const Factorization& view, const SheetLayout& layout,
                 const Listener& listener)
        : input_(input), view_(view), layout_(layout), listener_(listener) {
        const glm::dvec4 unit = input.classes.scale / double(Footprint::kOne);
        scale_ = glm::vec4(unit);
    }

    // Renders all slabs and returns their layers, front to back.
    std::vector<Layer> run() {
        const std::vector<Slab>& slabs = input_.grid.slabs;
        std::vector<std::optional<Layer>> layers(slabs.size());
        parallelFor(slabs.size(), [&](std::size_t i) { layers[i] = renderSlab(slabs[i]); });
        std::vector<Layer> frontToBack;
        for (auto& layer : layers) frontToBack.push_back(std::move(*layer));
        if (!view_.frontToBack) std::reverse(frontToBack.begin(), frontToBack.end());
        return frontToBack;
    }

    std::uint64_t stamps() const { return stamps_; }
    // The share of the slabs' time that went into compositing, 0..1.
    double compositeShare() const {
        return slabSeconds_ > 0 ? compositeSeconds_ / slabSeconds_ : 0;
    }

  private:
    Layer renderSlab(const Slab& slab) {
        const Clock::time_point start = Clock::now();
        std::unique_ptr<Sheet> sheet = takeSheet();
        Layer layer(reachOf(layout_, view_.shiftPerSlice, slab.firstSlice, slab.sliceCount));
        double compositeSeconds = 0;
        const std::uint64_t stamps =
            splatSlab(input_, slab, *sheet, [&](int slice, const Sheet& filled) {
                const Clock::time_point before = Clock::now();
                const SheetShift shift = shiftOf(layout_, view_.shiftPerSlice, slice);
                compositeSheet(filled, shift, scale_, view_.frontToBack, layer);
                compositeSeconds += secondsSince(before);
            });
        sheet->clear();
        finish(std::move(sheet), slab, stamps, compositeSeconds, secondsSince(start));
        return layer;
    }

    // Sheets are handed from slab to slab, so that there are never more than threads.
    std::unique_ptr<Sheet> takeSheet() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return std::make_unique<Sheet>(layout_);
        std::unique_ptr<Sheet> sheet = std::move(idle_.back());
        idle_.pop_back();
        return sheet;
    }

    void finish(std::unique_ptr<Sheet> sheet, const Slab& slab, std::uint64_t stamps,
                double compositeSeconds, double slabSeconds) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(sheet));
        stamps_ += stamps;
        compositeSeconds_ += compositeSeconds;
        slabSeconds_ += slabSeconds;
        slicesDone_ += slab.sliceCount;
        listener_.report(0.2 + 0.7 * slicesDone_ / input_.grid.box.dims().x);
    }

    const SplatInput& input_;
    const Factorization& view_;
    const SheetLayout& layout_;
    const Listener& listener_;
    glm::vec4 scale_;
    std::mutex mutex_;  // guards all below
    std::vector<std::unique_ptr<Sheet>> idle_;
    std::uint64_t stamps_ = 0;
    double compositeSeconds_ = 0;
    double slabSeconds_ = 0;
    int slicesDone_ = 0;
};

// Maps picture positions to base plane pixels: r a voxel, counted from the layout's first voxel and
// slice.
glm::dmat3 planeFromPixel(const Factorization& view, const SheetLayout& layout) {
    const glm::dvec2 origin =
        glm::dvec2(layout.firstVoxel) + double(layout.firstSlice) * view.shiftPerSlice;
    glm::dmat3 relative = view.baseFromPixel;
    relative[2] -= glm::dvec3(origin, 0);
    const double r = view.resolution;
    return glm::dmat3(r, 0, 0, 0, r, 0, 0, 0, 1) * relative;
}

Raster rasterOf(const Layer& layer) {
    return {layer.box.min, layer.box.size(), layer.rgba.data()};
}

// What all slabs together take: sheets and planes of slots for each thread, layers, and the merged
// one.
void requireSlabMemory(const DeltaGrid& grid, const Factorization& view,
                       const SheetLayout& layout) {
    const double blocks = double(layout.tiles().x) * layout.tiles().y / view.resolution;
    double bytes = (double(layout.bytes()) + 64 * sizeof(Slot) * blocks) *
                   std::min<double>(threadCount(), double(grid.slabs.size()));
    const auto layerBytes = [&](int firstSlice, int sliceCount) {
        const glm::dvec2 size = reachOf(layout, view.shiftPerSlice, firstSlice, sliceCount).size();
        return 16 * size.x * size.y;
    };
    for (const Slab& slab : grid.slabs) bytes += layerBytes(slab.firstSlice, slab.sliceCount);
    bytes += layerBytes(grid.box.min.x, grid.box.dims().x);
    requireMemory("sheets and layers at " + std::to_string(view.resolution) + " pixels a voxel",
                  bytes);
}

void renderGrid(const DeltaGrid& grid, const ClassTable& classes, const Factorization& view,
                const RenderOptions& options, const Listener& listener, RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const Footprint footprint = makeFootprint(options.sigma.value_or(defaultSigma(view.resolution)),
                                              view.shiftPerSlice, view.resolution);
    const StampWeights weights(footprint);
    const SheetLayout layout = layoutSheet(grid.box, footprint);
    requireSlabMemory(grid, view, layout);
    const SplatInput input{grid, classes, weights, footprint.radius,
                           options.method == Method::kTraditional};
    SlabRenderer slabs(input, view, layout, listener);
    const std::vector<Layer> layers = slabs.run();
    const double slabSeconds = secondsSince(start);

    const Layer merged = mergeLayers(layers);
    const double mergedSeconds = secondsSince(start);
    listener.report(0.95);

    warp(rasterOf(merged), planeFromPixel(view, layout), result.image);

    RenderStats& stats = result.stats;
    stats.stamps = slabs.stamps();
    stats.footprint = footprint.width();
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
    const std::vector<Slot> slotMap = mergeAlikeSlots(classes);
    listener.report(0.05);
    const DeltaGrid grid =
        makeDeltaGrid(volume, {view.sliceAxis, 0, encodingOf(options.method), slotMap});
    listener.report(0.2);

    RenderStats& stats = result.stats;
    stats.method = options.method;
    stats.voxels = std::uint64_t(volume.box.voxels());
    stats.visible = grid.visible();
    stats.deltas = grid.deltas();
    stats.slices = grid.box.dims().x;
    stats.slabs = int(grid.slabs.size());
    stats.sliceAxis = view.sliceAxis;
    stats.resolution = view.resolution;
    stats.prepareSeconds = secondsSince(start);
    if (!volume.empty()) renderGrid(grid, classes, view, options, listener, result);
    listener.report(1);
    return result;
}

}  // namespace deltasplat
