// SPDX-License-Identifier: Apache-2.0
#include "picture/picture_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/opacity_steps.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "screen/warp_region.h"
#include "splat/slice_blocks.h"
#include "view/factorization.h"

namespace deltasplat {

namespace {

// The covariance of a voxel's footprint, in voxels: uu, vv and uv.
glm::dvec3 covarianceOf(const Footprint& footprint) {
    glm::dvec3 products(0);
    for (int y = 0; y < footprint.width; ++y) {
        for (int x = 0; x < footprint.width; ++x) {
            const glm::dvec2 away = glm::dvec2(y, x) - 0.5 * (footprint.width - 1);
            products += double(footprint.at(x, y)) * glm::dvec3(away * away, away.x * away.y);
        }
    }
    // The weights of each phase sum to one.
    const double phases = footprint.resolution * footprint.resolution;
    return products / (double(Footprint::kOne) * phases * phases);
}

// Average covariance added by reading between sheet pixels; 0 if all lines of sight meet pixels.
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

void requireSize(const Camera& camera, const Image& image) {
    const glm::ivec2 size = camera.sizePixels;
    const std::size_t values = std::size_t{4} * std::size_t(size.x) * std::size_t(size.y);
    if (size.x < 1 || size.y < 1) {
        throw Error(ErrorCode::kUsage, "camera", dimsText(size) + " pixels",
                    "at least one each way");
    }
    if (image.size == size && image.rgba.size() == values) return;
    throw Error(ErrorCode::kUsage, "image",
                dimsText(image.size) + " pixels, " + std::to_string(image.rgba.size()) + " values",
                "the camera's " + dimsText(size) + ", four values each");
}

PictureView::PictureView(const PreparedScene::Impl& scene, const Camera& camera,
                         const ViewPlan& plan, std::shared_ptr<const PreparedAxis> axis,
                         KeptMemory& memory)
    : scene_(scene), camera_(camera), plan_(plan), axis_(std::move(axis)), layout_(plan.sheet) {
    layout_.channels = axis_->classes().oneColor ? 1 : 4;
    const double axisSteps = axis_->plan.steps;
    const VoxelPainter* painter = scene.painter.get();
    const bool isLit = painter && painter->dependsOnCamera();
    if (isLit || plan_.steps != axisSteps) {
        ClassTable classes = plan_.steps == axisSteps
                                 ? axis_->classes()
                                 : axis_->classes().atSteps(plan_.steps / axisSteps);
        const LitScene lit{camera,
                           scene.scene.volume->worldFromIndex() *
                               indexFromThinVoxel(axis_->sliceAxis(), axis_->parts()),
                           covarianceOf(plan_.footprint) +
                               covarianceOfReading(plan_.thin, plan_.footprint.resolution),
                           axis_->sliceAxis()};
        std::unique_ptr<const LookLight> light;
        if (painter) light = painter->lightOf(classes, isLit ? &lit : nullptr);
        colors_.emplace(axis_->deltas(), std::move(classes), std::move(light));
    }
    plane_.emplace(camera, placePlane());
    const StepColors& colors = colors_ ? *colors_ : axis_->colors;
    if (!colors.own() && !colors.classes().oneDigit()) {
        const bool withLow = !PixelSplatter::fits(plan_.footprint);
        digitVoxels_.emplace(axis_->deltas(), colors.classes(), withLow);
    }
    const bool stampEmptyVoxels = scene.options.method == Method::kTraditional;
    slabs_.emplace(SlabInput{{axis_->deltas(), colors, plan_.footprint,
                              digitVoxels_ ? &*digitVoxels_ : nullptr, stampEmptyVoxels, memory},
                             layout_,
                             plane_->plane(),
                             memory});
}

glm::dmat4 PictureView::worldFromSlices() const {
    return scene_.scene.volume->worldFromIndex() * indexFromThinVoxel(axis_->sliceAxis(), {});
}

PlanePlace PictureView::placePlane() const {
    PlanePlace place;
    place.view = plan_.view;
    place.thin = plan_.thin;
    place.parts = axis_->parts();
    place.firstSlice = layout_.firstSlice;
    place.firstVoxel = layout_.firstVoxel;
    if (plan_.view.eye) {
        place.spacing = plan_.slopeSpacing;
    } else {
        place.resolution = layout_.resolution;
        place.offsetPixels = layout_.offsetPixels;
    }
    place.filter = scene_.options.filter;
    // With one colour, every channel is a fixed share of the opacity.
    const ClassTable& classes = colors_ ? colors_->table() : axis_->colors.table();
    if (classes.oneColor) place.color = glm::dvec3(classes.scale) / classes.scale.a;
    return place;
}

double PictureView::show(Layer& layer, const PicturePart& part, const PlaneBox& whole) const {
    plane_->finish(layer);
    return plane_->showPart(layer, part, whole);
}

ErrorBound PictureView::errorBound() const {
    if (axis_->parts().joined > 1) return kUnknownError;
    if (scene_.options.tolerance.isExact()) return {};
    if (scene_.painter && !scene_.painter->mayHold()) return {};
    std::optional<double> brightest;
    if (scene_.painter) {
        const glm::dvec3 color =
            scene_.painter->lightOf(axis_->classes(), nullptr)->units().brightest();
        brightest = std::max({color.x, color.y, color.z});
    }
    const IndexBox& box = axis_->deltas().box;
    const Steps steps = plan_.view.eye && plane_->plane().cutsAny({box.min.x, box.max.x})
                            ? Steps::kOneShorter
                        : plan_.view.eye || plan_.steps != 1 ? Steps::kLonger
                                                             : Steps::kAsClassified;
    return deltasplat::errorBound(axis_->classes(), scene_.options.tolerance, steps, brightest);
}

namespace {

WarpFilter warpFilterOf(PictureFilter filter) {
    switch (filter) {
        case PictureFilter::kCatmullRom:
            return WarpFilter::kSharp;
        case PictureFilter::kMitchell:
            return WarpFilter::kMitchell;
        case PictureFilter::kGauss:
            return WarpFilter::kGauss;
        case PictureFilter::kBox:
            return WarpFilter::kBox;
    }
    return WarpFilter::kSharp;
}

}  // namespace

PlaneView::PlaneView(const Camera& camera, const PlanePlace& place)
    : camera_(camera), place_(place), plane_(makePlane()) {}

BasePlane PlaneView::makePlane() const {
    if (place_.view.eye)
        return {place_.thin, camera_, place_.firstSlice, place_.firstVoxel, place_.spacing};
    return {place_.thin, place_.firstSlice, place_.firstVoxel, place_.resolution,
            place_.offsetPixels};
}

void PlaneView::finish(Layer& layer) const {
    if (finishChangesLayer()) lengthenSteps(layer);
}

double PlaneView::showPart(const Layer& finished, const PicturePart& part,
                           const PlaneBox& whole) const {
    Raster raster{finished.box.min, finished.box.size(), finished.values.data(), finished.channels};
    raster.spans = finished.spans;
    if (!whole.empty()) {
        raster.wholeMin = whole.min;
        raster.wholeSize = whole.size();
    }
    if (place_.color) raster.color = *place_.color;
    const WarpFilter filter = warpFilterOf(place_.filter);
    if (place_.view.eye)
        return warpRegion(raster, camera_, place_.view, place_.thin, plane_, filter, part);
    return warp(raster, plane_.pixelFromPicture(), filter, part,
                *finished.values.get_allocator().resource());
}

PlaneBox PlaneView::readBy(const PixelBox& pixels) const {
    if (place_.view.eye) return readByRegion(camera_, place_.view, place_.thin, plane_, pixels);
    // A filter reaches twice its stretch; the rest allows for halving and padding taps (warp.cpp).
    constexpr double kReach = 5;
    constexpr double kLeast = 16;
    constexpr double kFar = 1 << 30;
    const glm::dmat3& map = plane_.pixelFromPicture();
    glm::dvec2 low(kFar), high(-kFar);
    for (const glm::ivec2 corner :
         {pixels.min, {pixels.max.x, pixels.min.y}, {pixels.min.x, pixels.max.y}, pixels.max}) {
        const glm::dvec2 position(map * glm::dvec3(corner, 1));
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const glm::dvec2 reach =
        kReach * glm::sqrt(glm::dvec2(map[0] * map[0] + map[1] * map[1])) + kLeast;
    return {glm::ivec2(glm::clamp(glm::floor(low - reach), -kFar, kFar)),
            glm::ivec2(glm::clamp(glm::ceil(high + reach), -kFar, kFar))};
}

// Turns opacities of straight steps through slices into those of the lines of sight.
void PlaneView::lengthenSteps(Layer& layer) const {
    parallelForChunks(std::size_t(layer.box.size().y), [&](std::size_t begin, std::size_t end) {
        std::vector<float> steps;
        for (std::size_t row = begin; row < end; ++row) {
            const glm::ivec2 span = layer.spans[row];
            if (span.x >= span.y) continue;
            const glm::ivec2 first = layer.box.min + glm::ivec2(span.x, int(row));
            steps.clear();
            for (int x = span.x; x < span.y; ++x)
                steps.push_back(float(plane_.stepsAt({layer.box.min.x + x, first.y})));
            const std::size_t count = steps.size();
            steps.resize(count + kStepsSpare);
            repeatOpacity(layer.pixel(first), steps.data(), count);
        }
    });
}

}  // namespace deltasplat
