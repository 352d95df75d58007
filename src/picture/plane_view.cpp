// SPDX-License-Identifier: Apache-2.0
#include "picture/plane_view.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <vector>

#include "base/opacity_steps.h"
#include "base/parallel.h"
#include "screen/warp_region.h"

namespace deltasplat {

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
    // As many times as a filter is wide, it reaches twice; the rest is what halving takes, and taps
    // that are read besides (warp.cpp).
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

// Opacities are those of ways straight through the slices: makes them those of the lines of sight.
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
