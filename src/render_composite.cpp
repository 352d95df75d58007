// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "composite/slab_renderer.h"
#include "default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "image/warp.h"
#include "image/warp_region.h"
#include "optics/hold_rule.h"
#include "optics/opacity_steps.h"
#include "parallel.h"
#include "prepared_axis.h"
#include "sheet_plan.h"
#include "stopwatch.h"

namespace deltasplat {
namespace {

// Of the picture's pixels that a line of the base plane has at most, seen from an eye: about what
// parallel projection has on average.
constexpr double kPixelsOfScreen = 0.7;

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
    CompositeRender(const PreparedScene::Impl& scene, const Camera& camera, Image& image,
                    RenderStats& stats)
        : scene_(scene),
          volume_(*scene.scene.volume),
          options_(scene.options),
          camera_(camera),
          image_(image),
          stats_(stats) {}

    // @param views  of the volume's own voxels
    void run(const std::vector<Factorization>& views, const Listener& listener) {
        // All of a picture is drawn alike.
        plan_.emplace(scene_, views.front(), listener);
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto share = [&](double part) { return (double(i) + part) / views.size(); };
            runView(views[i], partOf(listener, share(0), share(1)));
        }
    }

  private:
    void runView(const Factorization& view, const Listener& listener) {
        const Clock::time_point start = Clock::now();
        // From an eye, each pixel has its own.
        const double steps = view.eye ? 1 : stepsOf(view);
        const std::shared_ptr<const PreparedAxis> axis =
            scene_.axis(view.sliceAxis, plan_->partsAlong(view.sliceAxis), steps, listener);
        stats_.prepareSeconds += secondsSince(start);
        countIn(*axis);
        listener.report(0.2);
        if (volume_.empty()) return;
        const Clock::time_point renderStart = Clock::now();
        if (view.eye) {
            renderRegion(*axis, view, listener);
        } else {
            renderParallel(*axis, view, steps, listener);
        }
        stats_.renderSeconds += secondsSince(renderStart);
    }

    void countIn(const PreparedAxis& axis) {
        stats_.between = axis.parts.slices - 1;
        stats_.parts = axis.parts.voxels();
        stats_.slices = volume_.box.dims()[axis.sliceAxis] * axis.parts.slices;
        stats_.voxels = std::uint64_t(volume_.box.voxels()) * std::uint64_t(stats_.parts);
        stats_.visible = axis.deltas.visible();
        stats_.deltas = axis.deltas.deltas();
        stats_.slabs = int(axis.deltas.slabs.size());
        stats_.stamps += axis.stamps(options_.method);
    }

    // How long the way from one slice to the next is, as a multiple of the straight one.
    double stepsOf(const Factorization& view) const {
        // Rounding makes no straight view an oblique one.
        constexpr double kSame = 1e-12;
        const double steps =
            view.sliceStepWorld / planeDistance(volume_.worldFromIndex, view.sliceAxis);
        return std::abs(steps - 1) < kSame ? 1 : steps;
    }

    void renderParallel(const PreparedAxis& axis, const Factorization& view, double steps,
                        const Listener& listener) {
        Colors colors = colorsOf(axis.classes, axis.digitVoxels);
        std::optional<ClassTable> oblique;
        std::optional<DigitVoxels> digitVoxels;
        if (steps != axis.steps) {
            oblique = axis.classes.atSteps(steps / axis.steps);
            if (!oblique->oneDigit()) digitVoxels.emplace(axis.deltas, *oblique);
            colors = colorsOf(*oblique, digitVoxels);
        }
        const Footprint footprint = footprintOf(axis, view);
        const SheetLayout layout = layoutOf(axis, footprint);
        const BasePlane plane(subdivided(view, axis.parts), layout.firstSlice, layout.firstVoxel,
                              layout.resolution, layout.offsetPixels);
        const Layer merged = renderSlabs(axis, colors, footprint, layout, plane, listener);
        listener.report(0.95);
        const Clock::time_point warpStart = Clock::now();
        const glm::dmat3& map = plane.pixelFromPicture();
        warp(rasterOf(merged, *colors.classes), map, WarpFilter::kSharp, image_);
        stats_.warpSeconds += secondsSince(warpStart);
        boundError(axis.classes, options_.tolerance,
                   steps == 1 ? Steps::kAsClassified : Steps::kLonger, warpGain(map), stats_);
    }

    // What classes look like.
    struct Colors {
        const ClassTable* classes;
        const DigitVoxels* digitVoxels;
    };
    static Colors colorsOf(const ClassTable& classes, const std::optional<DigitVoxels>& voxels) {
        return {&classes, voxels ? &*voxels : nullptr};
    }

    Footprint footprintOf(const PreparedAxis& axis, const Factorization& view) {
        const int within = axis.parts.within;
        const double pixels = view.pixelsPerVoxel / within;
        const double sigma = options_.sigma.value_or(defaultSigma(pixels) / within);
        // The kernel is round in voxels, however many slices there are; seen along the middle line
        // of sight.
        const glm::dvec2 shift =
            view.eye ? 0.5 * (view.slopeMin + view.slopeMax) : view.shiftPerSlice;
        const Footprint footprint = makeFootprint(sigma, {shift.y, shift.x}, plan_->resolution(),
                                                  options_.footprintWidth, within);
        stats_.resolution = footprint.resolution * within;
        stats_.footprint = std::max(stats_.footprint, footprint.width);
        return footprint;
    }

    static SheetLayout layoutOf(const PreparedAxis& axis, const Footprint& footprint) {
        return layoutSheet(axis.deltas.box, footprint, axis.classes.oneColor ? 1 : 4);
    }

    Layer renderSlabs(const PreparedAxis& axis, const Colors& colors, const Footprint& footprint,
                      const SheetLayout& layout, const BasePlane& plane, const Listener& listener) {
        const SlabInput input{axis.deltas,
                              *colors.classes,
                              colors.digitVoxels,
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
        stats_.splatSeconds += splatSeconds;
        stats_.compositeSeconds += secondsSince(start) - splatSeconds;
        return merged;
    }

    void renderRegion(const PreparedAxis& axis, const Factorization& view,
                      const Listener& listener) {
        const Factorization thinView = subdivided(view, axis.parts);
        const IndexBox& box = axis.deltas.box;
        const Footprint footprint = footprintOf(axis, view);
        const SheetLayout layout = layoutOf(axis, footprint);
        const double density = densityOf(axis, thinView, layout.resolution);
        const BasePlane plane(thinView, camera_, layout.firstSlice, layout.firstVoxel, 1 / density);
        const Colors colors = colorsOf(axis.classes, axis.digitVoxels);
        Layer merged = renderSlabs(axis, colors, footprint, layout, plane, listener);
        if (axis.classes.oneColor) lengthenSteps(plane, merged);
        listener.report(0.95);
        const Clock::time_point warpStart = Clock::now();
        const double gain =
            warpRegion(rasterOf(merged, axis.classes), camera_, view, thinView, plane, image_);
        stats_.warpSeconds += secondsSince(warpStart);
        const bool cut = plane.cutsAny({box.min.x, box.max.x});
        boundError(axis.classes, options_.tolerance, cut ? Steps::kOneShorter : Steps::kLonger,
                   gain, stats_);
    }

    // Base plane pixels that a slope of 1 takes: as many as the farthest slice has sheet pixels,
    // which is the most that there is to show, or fewer: as many as the picture needs, but at least
    // as many as there are voxels in the slice in the middle. What is averaged before it is
    // composited is not what is seen of it.
    static double densityOf(const PreparedAxis& axis, const Factorization& view, int resolution) {
        const IndexBox& box = axis.deltas.box;
        const double farthest =
            view.frontToBack ? box.max.x - view.eye->x : view.eye->x - box.min.x;
        const double nearest =
            std::max(0.0, view.frontToBack ? box.min.x - view.eye->x : view.eye->x - box.max.x);
        const double middle = 0.5 * (nearest + farthest);
        const double needed =
            std::max(kPixelsOfScreen * view.pixelsPerSlope, middle / axis.parts.within);
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
                steps.resize(count + kStepsSpare);
                repeatOpacity(layer.pixel(first), steps.data(), count);
            }
        });
    }

    const PreparedScene::Impl& scene_;
    const Volume& volume_;
    const SplatOptions& options_;
    const Camera& camera_;
    Image& image_;
    RenderStats& stats_;
    std::optional<SheetPlan> plan_;
};

std::vector<Factorization> viewsOf(const Camera& camera, const Volume& volume,
                                   const SplatOptions& options) {
    if (camera.projection == Projection::kOrtho)
        return {factorize(camera, volume.worldFromIndex, options.resolution)};
    return factorizeRegions(camera, volume.box, volume.worldFromIndex, options.resolution);
}

void requireSize(const Camera& camera, const Image& image) {
    const glm::ivec2 size = camera.sizePixels;
    const std::size_t values = std::size_t{4} * std::size_t(size.x) * std::size_t(size.y);
    if (image.size == size && image.rgba.size() == values) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("image",
                            std::to_string(image.size.x) + "x" + std::to_string(image.size.y) +
                                " pixels, " + std::to_string(image.rgba.size()) + " values",
                            "the camera's " + std::to_string(size.x) + "x" +
                                std::to_string(size.y) + ", four values each"));
}

}  // namespace

RenderStats renderComposite(const PreparedScene& scene, const Camera& camera, Image& image,
                            const Listener& listener) {
    return renderComposite(scene.impl(), camera, image, listener);
}

RenderStats renderComposite(const PreparedScene::Impl& scene, const Camera& camera, Image& image,
                            const Listener& listener) {
    const DefaultFloats floats;
    requireSize(camera, image);
    std::fill(image.rgba.begin(), image.rgba.end(), 0.0f);
    const std::vector<Factorization> views = viewsOf(camera, *scene.scene.volume, scene.options);
    RenderStats stats;
    stats.mode = Mode::kComposite;
    stats.method = scene.options.method;
    stats.tolerance = scene.options.tolerance;
    stats.sliceAxis = views.front().sliceAxis;
    CompositeRender(scene, camera, image, stats).run(views, listener);
    return stats;
}

}  // namespace deltasplat
