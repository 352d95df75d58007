// SPDX-License-Identifier: Apache-2.0
#include "ray_render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "image/warp.h"
#include "number_text.h"
#include "optics/value_colors.h"
#include "parallel.h"
#include "rays/blur_plane.h"
#include "rays/follow_rays.h"
#include "stopwatch.h"

namespace deltasplat {
namespace {

// Sheet pixels a voxel.
constexpr int kResolution = 1;

// A voxel stands for itself: what is between is for the warp to find.
Footprint singlePixel() {
    Footprint footprint;
    footprint.weights = {Footprint::kOne};
    return footprint;
}

Footprint footprintOf(const RenderOptions& options, glm::dvec2 shiftPerSlice) {
    if (options.mode == Mode::kMip || !options.sigma) return singlePixel();
    return makeFootprint(*options.sigma, shiftPerSlice, kResolution, options.footprintWidth);
}

Raster rasterOf(const RayPlane& plane) {
    return {plane.box.min, plane.box.size(), plane.values.data(), 1};
}

// Splits a plane of largest values into whether anything is met (1 or 0), and the value there.
RayPlane splitMet(RayPlane& plane) {
    RayPlane met(plane.box);
    parallelForChunks(plane.values.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            met.values[i] = std::isinf(plane.values[i]) ? 0.0f : 1.0f;
            if (met.values[i] == 0) plane.values[i] = 0;
        }
    });
    return met;
}

// Makes the picture of values and of what is met, both warped: a pixel is met where it is by half
// or more, and has the mean of the values that are.
void combineMet(const Image& met, glm::vec2 range, Image& image) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        const float* share = met.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4, share += 4) {
            const bool isMet = share[3] >= 0.5f;
            const float value = isMet ? std::clamp(rgba[3] / share[3], range.x, range.y) : 0.0f;
            for (int c = 0; c < 3; ++c) rgba[c] = value;
            rgba[3] = isMet ? 1.0f : 0.0f;
        }
    });
}

void colorValues(const ValueColors& colors, Image& image) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4) {
            if (rgba[3] == 0) continue;
            const glm::vec3 color = colors.colorOf(rgba[0]);
            for (int c = 0; c < 3; ++c) rgba[c] = color[c];
        }
    });
}

// Rays reckon in 32-bit floats: says where these are not enough.
void warnOfFloats(const Volume& volume, const Factorization& view, RayRule rule,
                  const Listener& listener) {
    const double largest = std::max(std::abs(volume.valueMin), std::abs(volume.valueMax));
    // Below, numbers lose digits: 1e5 times that is what 1e-5 of the largest value needs.
    constexpr double kSmallest = 1e5 * double(std::numeric_limits<float>::min());
    const std::string values = "values of up to " + numberText(largest);
    // Values are added up before they are multiplied by the length of a step.
    const double step = rule == RayRule::kSum ? view.sliceStepWorld : 1;
    const double sum = largest * volume.box.dims()[view.sliceAxis] * std::max(step, 1.0);
    if (largest > kLargestRayValue) {
        listener.warn(values +
                      ": those beyond +-8.5e+37 are taken for that, as x-rays and largest "
                      "values are 32-bit floats");
    } else if (largest > 0 && largest * std::min(step, 1.0) < kSmallest) {
        listener.warn(values + " lose digits, or become 0, as 32-bit floats");
    }
    if (rule == RayRule::kSum && sum > double(std::numeric_limits<float>::max())) {
        listener.warn(values +
                      " may add up to more than a 32-bit float holds: pixels are wrong where they "
                      "do");
    }
}

}  // namespace

void renderRays(const Volume& volume, const Factorization& view, const RenderOptions& options,
                const Listener& listener, RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const bool mip = options.mode == Mode::kMip;
    const RayRule rule = mip ? RayRule::kMax : RayRule::kSum;
    warnOfFloats(volume, view, rule, listener);
    const RayVolume rays = makeRayVolume(volume, view.sliceAxis, rule);
    RenderStats& stats = result.stats;
    stats.prepareSeconds = secondsSince(start);

    const Clock::time_point renderStart = Clock::now();
    const Footprint footprint = footprintOf(options, {view.shiftPerSlice.y, view.shiftPerSlice.x});
    const SheetLayout layout = layoutSheet(rays.box, footprint, 1);
    const BasePlane basePlane(view, layout.firstSlice, layout.firstVoxel, layout.resolution,
                              layout.offsetPixels);
    RayPlane plane = followRays({rays, rule, layout, basePlane}, listener);
    stats.splatSeconds = secondsSince(renderStart);

    const glm::dmat3& map = basePlane.pixelFromPicture();
    if (mip) {
        const RayPlane met = splitMet(plane);
        stats.compositeSeconds = secondsSince(renderStart) - stats.splatSeconds;
        Image share(result.image.size);
        warp(rasterOf(met), map, WarpFilter::kLinear, share);
        warp(rasterOf(plane), map, WarpFilter::kLinear, result.image);
        combineMet(share, {rays.lowest, rays.highest}, result.image);
        if (options.mipColors) colorValues(ValueColors(volume, options.optics), result.image);
    } else {
        plane = blurPlane(plane, footprint, float(view.sliceStepWorld));
        stats.compositeSeconds = secondsSince(renderStart) - stats.splatSeconds;
        warp(rasterOf(plane), map, WarpFilter::kSmooth, result.image);
    }
    stats.visible = rays.visible;
    stats.resolution = kResolution;
    stats.footprint = footprint.width;
    stats.renderSeconds = secondsSince(renderStart);
    stats.warpSeconds = stats.renderSeconds - stats.splatSeconds - stats.compositeSeconds;
}

}  // namespace deltasplat
