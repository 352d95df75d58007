// SPDX-License-Identifier: Apache-2.0
#include "picture/picture_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "splat/pixel_splatter.h"
#include "view/factorization.h"

namespace deltasplat {
namespace {

// Of the picture's pixels that a line of the base plane has at most, seen from an eye: about what
// parallel projection has on average.
constexpr double kPixelsOfScreen = 0.7;

// Of the slopes of a region, that of the way a camera looks, or the one nearest to it: what is
// around a picture's frame does not move it.
glm::dvec2 middleSlope(const Camera& camera, const Factorization& view) {
    const glm::dvec3 ahead = glm::inverse(view.worldFromStep) * camera.direction;
    if (camera.projection == Projection::kLatlong || !(ahead.x > 0))
        return 0.5 * (view.slopeMin + view.slopeMax);
    return glm::clamp(glm::dvec2(ahead.y, ahead.z) / ahead.x, view.slopeMin, view.slopeMax);
}

Footprint makeViewFootprint(const PreparedScene::Impl& scene, const Camera& camera,
                            const Factorization& view, const SheetPlan& plan) {
    const SplatOptions& options = scene.options;
    const int within = plan.partsIn(view).within;
    const double pixels = view.pixelsPerVoxel / within;
    const double sigma = options.sigma.value_or(defaultSigma(pixels, plan.resolution()) / within);
    // The kernel is round in voxels, however many slices there are; seen along the middle line of
    // sight.
    const glm::dvec2 shift = view.eye ? middleSlope(camera, view) : view.shiftPerSlice;
    return makeFootprint(sigma, {shift.y, shift.x}, int(plan.resolution()),
                         plan.footprintWidth(view), within);
}

std::vector<Factorization> factorizeAll(const PreparedScene::Impl& scene, const Camera& camera,
                                        bool atSlopeSteps) {
    const Volume& volume = *scene.scene.volume;
    const std::optional<double> resolution = scene.options.resolution;
    if (camera.projection == Projection::kOrtho)
        return {factorize(camera, volume.worldFromIndex, resolution)};
    std::vector<Factorization> views =
        factorizeRegions(camera, volume.box, volume.worldFromIndex, resolution, atSlopeSteps);
    if (!views.empty()) return views;
    throw Error(ErrorCode::kUsage,
                gotExpected("camera", "no lines of sight", "what makeCamera returns"));
}

// Base plane pixels that a slope of 1 takes: as many as the farthest slice has sheet pixels, which
// is the most that there is to show, or fewer: as many as the picture needs, but at least as many
// as there are voxels in the slice in the middle, or sheet pixels if those are fewer. What is
// averaged before it is composited is not what is seen of it.
// @param view         of thin voxels
// @param box          of all slices
// @param sheetPixels  of a thin voxel
double planeDensity(const Factorization& view, const IndexBox& box, double sheetPixels,
                    int within) {
    const double farthest = view.frontToBack ? box.max.x - view.eye->x : view.eye->x - box.min.x;
    const double nearest =
        std::max(0.0, view.frontToBack ? box.min.x - view.eye->x : view.eye->x - box.max.x);
    const double middle = 0.5 * (nearest + farthest);
    const double needed = std::max(kPixelsOfScreen * view.pixelsPerSlope,
                                   middle * std::min(sheetPixels, 1.0) / within);
    const double most = sheetPixels * std::max(farthest, 1.0);
    // Reading sheets that are not averaged takes so much less time.
    constexpr double kWorthMore = 1.3;
    return most < kWorthMore * needed ? most : needed;
}

// The covariance of where a voxel is seen in a footprint, in voxels: uu, vv and uv.
glm::dvec3 covarianceOf(const Footprint& footprint) {
    glm::dvec3 products(0);
    for (int y = 0; y < footprint.width; ++y) {
        for (int x = 0; x < footprint.width; ++x) {
            const glm::dvec2 away = glm::dvec2(y, x) - 0.5 * (footprint.width - 1);
            products += double(footprint.at(x, y)) * glm::dvec3(away * away, away.x * away.y);
        }
    }
    // Weights of each of the phases add up to one.
    const double phases = footprint.resolution * footprint.resolution;
    return products / (double(Footprint::kOne) * phases * phases);
}

// What reading sheets between their pixels adds to that: on average, as lines of sight lie anywhere
// between, but where all of them meet pixels.
glm::dvec3 covarianceOfReading(const Factorization& view, double sheetPixels) {
    glm::dvec3 covariance(0);
    for (int i = 0; i < 2; ++i) {
        const double pixels = view.shiftPerSlice[i] * sheetPixels;
        const bool isBetween = view.eye || std::abs(pixels - std::round(pixels)) >= kSnap;
        if (isBetween) covariance[i] = 1 / (6 * sheetPixels * sheetPixels);
    }
    return covariance;
}

}  // namespace

ViewPlan::ViewPlan(const PreparedScene::Impl& scene, const Camera& camera, bool keepsSlices,
                   const Listener& listener)
    : views(factorizeAll(scene, camera, false)),
      sheets(scene, camera, views.front(), keepsSlices, listener) {
    if (sheets.joined() == 1 || !views.front().eye) return;
    // Slices are joined along lines of sight, as far as whole voxels are; of several colours, where
    // steps are nearly as long as those that pairs are mixed for.
    std::vector<Factorization> atSlopes = factorizeAll(scene, camera, true);
    constexpr double kMostRange = 1.3;
    const bool areAlike =
        std::all_of(atSlopes.begin(), atSlopes.end(),
                    [](const Factorization& view) { return view.stepRange < kMostRange; });
    if (scene.hasOneColor() || areAlike) {
        views = std::move(atSlopes);
    } else {
        sheets = SheetPlan(scene, camera, views.front(), true, listener);
    }
}

double stepsOf(const Factorization& view, const Volume& volume) {
    if (view.eye) return view.steps;
    // Rounding makes no straight view an oblique one.
    constexpr double kSame = 1e-12;
    const double steps = view.sliceStepWorld / planeDistance(volume.worldFromIndex, view.sliceAxis);
    return std::abs(steps - 1) < kSame ? 1 : steps;
}

glm::dvec3 indexOfEye(const Factorization& view) {
    const glm::ivec3 order = sliceOrder(view.sliceAxis);
    glm::dvec3 eye;
    for (int i = 0; i < 3; ++i) eye[order[i]] = (*view.eye)[i];
    return eye;
}

SeenCone seenCone(const PreparedScene::Impl& scene, const Camera& camera, const Factorization& view,
                  const SheetPlan& plan) {
    const Subdivision parts = plan.partsIn(view);
    const Factorization thin = subdivided(view, parts);
    const Footprint footprint = makeViewFootprint(scene, camera, view, plan);
    const double sheetPixels = footprint.resolution;
    const IndexBox box = boxOfSlices(scene.scene.volume->box, view.sliceAxis, parts);
    const double spacing = 1 / planeDensity(thin, box, sheetPixels, parts.within);
    SeenCone cone;
    cone.eye = *view.eye;
    cone.frontToBack = view.frontToBack;
    // In slopes of the volume's own slices and voxels.
    cone.reachPerSlice = spacing * view.slopeLimit / thin.slopeLimit;
    const double border = (planeBorder(thin, spacing) + 3) * cone.reachPerSlice;
    cone.slopeMin = view.slopeMin - border;
    cone.slopeMax = view.slopeMax + border;
    // What is joined lies up to a voxel beside what it is made of, and what is mixed next to it.
    constexpr double kBeside = 2;
    cone.reach = (footprint.reach() + 2) / sheetPixels / parts.within + kBeside;
    return cone;
}

void requireSize(const Camera& camera, const Image& image) {
    const glm::ivec2 size = camera.sizePixels;
    const std::size_t values = std::size_t{4} * std::size_t(size.x) * std::size_t(size.y);
    if (size.x < 1 || size.y < 1) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("camera", dimsText(size) + " pixels", "at least one each way"));
    }
    if (image.size == size && image.rgba.size() == values) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("image",
                            dimsText(image.size) + " pixels, " + std::to_string(image.rgba.size()) +
                                " values",
                            "the camera's " + dimsText(size) + ", four values each"));
}

PictureView::PictureView(const PreparedScene::Impl& scene, const Camera& camera,
                         const Factorization& view, const SheetPlan& plan,
                         std::shared_ptr<const PreparedAxis> axis, KeptMemory& memory)
    : scene_(scene),
      camera_(camera),
      view_(view),
      axis_(std::move(axis)),
      steps_(stepsOf(view, *scene.scene.volume)),
      thinView_(subdivided(view, axis_->parts)),
      footprint_(makeViewFootprint(scene, camera, view, plan)),
      layout_(layoutSheet(axis_->deltas().box, footprint_, axis_->classes().oneColor ? 1 : 4)) {
    const VoxelPainter* painter = scene.painter.get();
    const bool isLit = painter && painter->dependsOnCamera();
    if (isLit || steps_ != axis_->steps) {
        ClassTable classes = steps_ == axis_->steps
                                 ? axis_->classes()
                                 : axis_->classes().atSteps(steps_ / axis_->steps);
        const LitScene lit{
            camera,
            scene.scene.volume->worldFromIndex * indexFromThinVoxel(axis_->sliceAxis, axis_->parts),
            covarianceOf(footprint_) + covarianceOfReading(thinView_, footprint_.resolution),
            axis_->sliceAxis};
        std::unique_ptr<const LookLight> light;
        if (painter) light = painter->lightOf(classes, isLit ? &lit : nullptr);
        colors_.emplace(axis_->deltas(), std::move(classes), std::move(light));
    }
    plane_.emplace(camera, placePlane());
    const StepColors& colors = colors_ ? *colors_ : axis_->colors;
    if (!colors.own() && !colors.classes().oneDigit()) {
        const bool withLow = !PixelSplatter::fits(footprint_);
        digitVoxels_.emplace(axis_->deltas(), colors.classes(), withLow);
    }
    const bool stampEmptyVoxels = scene.options.method == Method::kTraditional;
    slabs_.emplace(SlabInput{{axis_->deltas(), colors, footprint_,
                              digitVoxels_ ? &*digitVoxels_ : nullptr, stampEmptyVoxels, memory},
                             layout_,
                             plane_->plane(),
                             memory});
}

glm::dmat4 PictureView::worldFromSlices() const {
    return scene_.scene.volume->worldFromIndex * indexFromThinVoxel(axis_->sliceAxis, {});
}

PlanePlace PictureView::placePlane() const {
    PlanePlace place;
    place.view = view_;
    place.parts = axis_->parts;
    place.firstSlice = layout_.firstSlice;
    place.firstVoxel = layout_.firstVoxel;
    if (view_.eye) {
        place.spacing = 1 / planeDensity(thinView_, axis_->deltas().box, layout_.resolution,
                                         axis_->parts.within);
    } else {
        place.resolution = layout_.resolution;
        place.offsetPixels = layout_.offsetPixels;
    }
    place.filter = scene_.options.filter;
    // Of one colour, every channel is a fixed share of the opacity.
    const ClassTable& classes = colors_ ? colors_->table() : axis_->colors.table();
    if (classes.oneColor) place.color = glm::dvec3(classes.scale) / classes.scale.a;
    return place;
}

double PictureView::show(Layer& layer, const PicturePart& part, const PlaneBox& whole) const {
    finish(layer);
    return plane_->showPart(layer, part, whole);
}

ErrorBound PictureView::errorBound() const {
    if (axis_->parts.joined > 1) return kUnknownError;
    if (scene_.options.tolerance.isExact()) return {};
    if (scene_.painter && !scene_.painter->mayHold()) return {};
    std::optional<double> brightest;
    if (scene_.painter) {
        const glm::dvec3 color =
            scene_.painter->lightOf(axis_->classes(), nullptr)->units().brightest();
        brightest = std::max({color.x, color.y, color.z});
    }
    const IndexBox& box = axis_->deltas().box;
    const Steps steps = view_.eye && plane_->plane().cutsAny({box.min.x, box.max.x})
                            ? Steps::kOneShorter
                        : view_.eye || steps_ != 1 ? Steps::kLonger
                                                   : Steps::kAsClassified;
    return deltasplat::errorBound(axis_->classes(), scene_.options.tolerance, steps, brightest);
}

}  // namespace deltasplat
