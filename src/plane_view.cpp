// SPDX-License-Identifier: Apache-2.0
#include "plane_view.h"

#include <vector>

#include "image/warp_region.h"
#include "optics/opacity_steps.h"
#include "parallel.h"

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
    : camera_(camera),
      place_(place),
      thin_(subdivided(place.view, place.parts)),
      plane_(makePlane()) {}

BasePlane PlaneView::makePlane() const {
    if (place_.view.eye)
        return {thin_, camera_, place_.firstSlice, place_.firstVoxel, place_.spacing};
    return {thin_, place_.firstSlice, place_.firstVoxel, place_.resolution, place_.offsetPixels};
}

void PlaneView::finish(Layer& layer) const {
    if (finishChangesLayer()) lengthenSteps(layer);
}

double PlaneView::showPart(const Layer& finished, const PicturePart& part) const {
    Raster raster{finished.box.min, finished.box.size(), finished.values.data(), finished.channels};
    raster.spans = finished.spans;
    if (place_.color) raster.color = *place_.color;
    const WarpFilter filter = warpFilterOf(place_.filter);
    if (place_.view.eye)
        return warpRegion(raster, camera_, place_.view, thin_, plane_, filter, part);
    return warp(raster, plane_.pixelFromPicture(), filter, part,
                *finished.values.get_allocator().resource());
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
