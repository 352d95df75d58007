// SPDX-License-Identifier: Apache-2.0
#include "composite_render.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "composite/scaled_kernels.h"
#include "composite/slab_renderer.h"
#include "image/warp.h"
#include "image/warp_region.h"
#include "optics/hold_rule.h"
#include "parallel.h"
#include "sheet_plan.h"
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

// Optics as the volume has them, for levels to be seen by.
Optics withRange(const Volume& volume, Optics optics) {
    if (!optics.range) optics.range = defaultRange(volume);
    return optics;
}

// Of the picture's pixels that a line of the base plane has at most, seen from an eye: about what
// parallel projection has on average.
constexpr double kPixelsOfScreen = 0.7;

// A volume as slices along one axis: what is rendered, whatever the camera.
struct PreparedSlices {
    Subdivision parts;
    ClassTable classes;
    PackedDeltas deltas;
    std::optional<DigitVoxels> digitVoxels;
};

// Footprints that a method adds.
std::uint64_t stampsOf(const PackedDeltas& deltas, const RenderStats& stats) {
    if (stats.method == Method::kTraditional) return stats.voxels;
    std::uint64_t stamps = 0;
    for (const PlannedSlab& slab : deltas.slabs) stamps += slab.stamps();
    return stamps;
}

Raster rasterOf(const Layer& layer, const ClassTable& classes) {
    Raster raster{layer.box.min, layer.box.size(), layer.values.data(), layer.channels};
    raster.spans = layer.spans;
    // Of one colour, every channel is a fixed share of the opacity.
    if (classes.oneColor) raster.color = glm::dvec3(classes.scale) / classes.scale.a;
    return raster;
}

void boundError(const ClassTable& classes, const Tolerance& tolerance, Steps steps, double gain,
                RenderStats& stats) {
    if (tolerance.isExact()) return;
    const ErrorBound bound = errorBound(classes, tolerance, steps);
    stats.errorBoundColor = std::max(stats.errorBoundColor, bound.color * gain);
    stats.errorBoundAlpha = std::max(stats.errorBoundAlpha, bound.alpha * gain);
}

Listener partOf(const Listener& listener, double from, double to) {
    return {[&listener, from, to](double share) { listener.report(from + (to - from) * share); },
            listener.warning};
}

// Renders one picture, or the regions of one.
class CompositeRender {
  public:
    CompositeRender(const Volume& volume, const RenderOptions& options, RenderResult& result)
        : volume_(volume),
          options_(options),
          optics_(withRange(volume, options.optics)),
          result_(result) {}

    // @param view  of the volume's own voxels
    void run(const Factorization& view, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        const PreparedSlices slices = prepare(view, listener);
        result_.stats.prepareSeconds = secondsSince(start);
        listener.report(0.2);
        if (volume_.empty()) return;
        const Clock::time_point renderStart = Clock::now();
        const Footprint footprint = footprintOf(slices, view);
        const SheetLayout layout = layoutOf(slices, footprint);
        const BasePlane plane(subdivided(view, slices.parts), layout.firstSlice, layout.firstVoxel,
                              layout.resolution, layout.offsetPixels);
        const Layer merged = renderSlabs(slices, footprint, layout, plane, listener);
        listener.report(0.95);
        const Clock::time_point warpStart = Clock::now();
        const glm::dmat3& map = plane.pixelFromPicture();
        warp(rasterOf(merged, slices.classes), map, WarpFilter::kSharp, result_.image);
        result_.stats.warpSeconds = secondsSince(warpStart);
        boundError(slices.classes, options_.tolerance, Steps::kAsClassified, warpGain(map),
                   result_.stats);
        result_.stats.renderSeconds = secondsSince(renderStart);
    }

    // @param regions  of the volume's own voxels
    void run(const std::vector<Factorization>& regions, const Listener& listener) {
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const auto share = [&](double part) { return (double(i) + part) / regions.size(); };
            runRegion(regions[i], partOf(listener, share(0), share(1)));
        }
    }

  private:
    PreparedSlices prepare(const Factorization& view, const Listener& listener) {
        RenderStats& stats = result_.stats;
        PreparedSlices slices{{}, classify(volume_, optics_, view.sliceStepWorld), {}, {}};
        if (!plan_) plan_.emplace(volume_, view, slices.classes, options_, listener);
        slices.parts = plan_->partsAlong(view.sliceAxis);
        std::optional<ValueMixer> mixer;
        if (slices.parts.divides()) {
            mixer.emplace(volume_, slices.parts);
            slices.classes =
                classify(mixer->levels(), optics_, view.sliceStepWorld / slices.parts.slices);
        }
        const Volume& seen = mixer ? mixer->levels() : volume_;
        listener.report(0.05);
        slices.deltas = packDeltas(
            volume_,
            {view.sliceAxis, encodingOf(options_.method), slices.classes.classOfSlot,
             holdRule(seen, slices.classes, options_.tolerance), mixer ? &*mixer : nullptr});
        if (!slices.classes.oneDigit()) slices.digitVoxels.emplace(slices.deltas, slices.classes);

        stats.between = slices.parts.slices - 1;
        stats.parts = slices.parts.voxels();
        stats.slices = volume_.box.dims()[view.sliceAxis] * slices.parts.slices;
        stats.voxels = std::uint64_t(volume_.box.voxels()) * std::uint64_t(stats.parts);
        stats.tolerance = options_.tolerance;
        stats.visible = slices.deltas.visible();
        stats.deltas = slices.deltas.deltas();
        stats.slabs = int(slices.deltas.slabs.size());
        stats.stamps += stampsOf(slices.deltas, stats);
        return slices;
    }

    Footprint footprintOf(const PreparedSlices& slices, const Factorization& view) {
        const int within = slices.parts.within;
        const double pixels = view.pixelsPerVoxel / within;
        const double sigma = options_.sigma.value_or(defaultSigma(pixels) / within);
        // The kernel is round in voxels, however many slices there are; seen along the middle line
        // of sight.
        const glm::dvec2 shift =
            view.eye ? 0.5 * (view.slopeMin + view.slopeMax) : view.shiftPerSlice;
        const Footprint footprint = makeFootprint(sigma, {shift.y, shift.x}, plan_->resolution(),
                                                  options_.footprintWidth, within);
        result_.stats.resolution = footprint.resolution * within;
        result_.stats.footprint = std::max(result_.stats.footprint, footprint.width);
        return footprint;
    }

    static SheetLayout layoutOf(const PreparedSlices& slices, const Footprint& footprint) {
        return layoutSheet(slices.deltas.box, footprint, slices.classes.oneColor ? 1 : 4);
    }

    Layer renderSlabs(const PreparedSlices& slices, const Footprint& footprint,
                      const SheetLayout& layout, const BasePlane& plane, const Listener& listener) {
        const SlabInput input{slices.deltas,
                              slices.classes,
                              slices.digitVoxels ? &*slices.digitVoxels : nullptr,
                              options_.method == Method::kTraditional,
                              footprint,
                              layout,
                              plane};
        const Listener slabsListener = partOf(listener, 0.2, 0.9);
        const Clock::time_point start = Clock::now();
        SlabRenderer slabs(input, slabsListener);
        slabs.run();
        const double slabSeconds = secondsSince(start);
        Layer merged = slabs.merge();
        const double splatSeconds = slabSeconds * (1 - slabs.compositeShare());
        result_.stats.splatSeconds += splatSeconds;
        result_.stats.compositeSeconds += secondsSince(start) - splatSeconds;
        return merged;
    }

    void runRegion(const Factorization& view, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        const PreparedSlices slices = prepare(view, listener);
        result_.stats.prepareSeconds += secondsSince(start);
        listener.report(0.2);
        if (volume_.empty()) return;
        const Clock::time_point renderStart = Clock::now();
        renderRegion(slices, view, listener);
        result_.stats.renderSeconds += secondsSince(renderStart);
    }

    void renderRegion(const PreparedSlices& slices, const Factorization& view,
                      const Listener& listener) {
        const Factorization thinView = subdivided(view, slices.parts);
        const IndexBox& box = slices.deltas.box;
        const Footprint footprint = footprintOf(slices, view);
        const SheetLayout layout = layoutOf(slices, footprint);
        const double density = densityOf(slices, thinView, layout.resolution);
        const BasePlane plane(thinView, result_.camera, layout.firstSlice, layout.firstVoxel,
                              1 / density);
        Layer merged = renderSlabs(slices, footprint, layout, plane, listener);
        if (merged.channels == 1) lengthenSteps(plane, merged);
        listener.report(0.95);
        const Clock::time_point warpStart = Clock::now();
        const double gain = warpRegion(rasterOf(merged, slices.classes), result_.camera, view,
                                       thinView, plane, result_.image);
        result_.stats.warpSeconds += secondsSince(warpStart);
        const bool cut = plane.cutsAny({box.min.x, box.max.x});
        boundError(slices.classes, options_.tolerance, cut ? Steps::kOneShorter : Steps::kLonger,
                   gain, result_.stats);
    }

    // Base plane pixels that a slope of 1 takes: as many as the farthest slice has sheet pixels,
    // which is the most that there is to show, or fewer: as many as the picture needs, but at least
    // as many as there are voxels in the slice in the middle. What is averaged before it is
    // composited is not what is seen of it.
    static double densityOf(const PreparedSlices& slices, const Factorization& view,
                            int resolution) {
        const IndexBox& box = slices.deltas.box;
        const double farthest =
            view.frontToBack ? box.max.x - view.eye->x : view.eye->x - box.min.x;
        const double nearest =
            std::max(0.0, view.frontToBack ? box.min.x - view.eye->x : view.eye->x - box.max.x);
        const double middle = 0.5 * (nearest + farthest);
        const double needed =
            std::max(kPixelsOfScreen * view.pixelsPerSlope, middle / slices.parts.within);
        const double most = resolution * std::max(farthest, 1.0);
        // Reading sheets that are not averaged takes so much less time.
        constexpr double kWorthMore = 1.3;
        return most < kWorthMore * needed ? most : needed;
    }

    // Opacities are those of ways straight through the slices: makes them those of the lines of
    // sight.
    static void lengthenSteps(const BasePlane& plane, Layer& layer) {
        parallelForChunks(std::size_t(layer.box.size().y), [&](std::size_t begin, std::size_t end) {
            std::vector<float> steps;
            for (std::size_t row = begin; row < end; ++row) {
                const glm::ivec2 span = layer.spans[row];
                if (span.x >= span.y) continue;
                const glm::ivec2 first = layer.box.min + glm::ivec2(span.x, int(row));
                steps.clear();
                for (int x = span.x; x < span.y; ++x)
                    steps.push_back(float(plane.stepsAt({layer.box.min.x + x, first.y})));
                const std::size_t count = steps.size();
                steps.resize(count + StepLengths::kSpare);
                repeatOpacity(layer.pixel(first), steps.data(), count);
            }
        });
    }

    const Volume& volume_;
    const RenderOptions& options_;
    Optics optics_;
    RenderResult& result_;
    std::optional<SheetPlan> plan_;
};

}  // namespace

void renderComposite(const Volume& volume, const RenderOptions& options, const Listener& listener,
                     RenderResult& result) {
    CompositeRender render(volume, options, result);
    const Camera& camera = result.camera;
    if (camera.projection == Projection::kOrtho) {
        const Factorization view = factorize(camera, volume.worldFromIndex, options.resolution);
        result.stats.sliceAxis = view.sliceAxis;
        render.run(view, listener);
        return;
    }
    const std::vector<Factorization> regions =
        factorizeRegions(camera, volume.box, volume.worldFromIndex, options.resolution);
    result.stats.sliceAxis = regions.front().sliceAxis;
    render.run(regions, listener);
}

}  // namespace deltasplat
