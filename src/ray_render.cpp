// SPDX-License-Identifier: Apache-2.0
#include "ray_render.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "deltasplat/ingest/slot.h"
#include "empty_picture.h"
#include "eye_render.h"
#include "image/warp.h"
#include "parallel.h"
#include "ray_picture.h"
#include "rays/blur_plane.h"
#include "rays/depth_shade.h"
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
    if (!showsSums(options.mode) || !options.sigma) return singlePixel();
    return makeFootprint(*options.sigma, shiftPerSlice, kResolution, options.footprintWidth);
}

Raster rasterOf(const RayPlane& plane) {
    return {plane.box.min, plane.box.size(), plane.values.data(), 1};
}

// Splits a plane of values into whether anything is met (1 or 0), and the value there.
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

// Makes means of sums, and of how much of each pixel's way is in active voxels; where none is,
// -infinity.
void divideByCounts(const RayPlane& counts, RayPlane& sums) {
    parallelForChunks(sums.values.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float count = counts.values[i];
            sums.values[i] =
                count > 0 ? sums.values[i] / count : -std::numeric_limits<float>::infinity();
        }
    });
}

// Makes the picture of values, of what is met and of shades, all warped: a pixel is met where it is
// by half or more, and has the means of the values and shades that are.
void combineMet(const Image& met, const Image* shade, const ValuePainter& painter, Image& image) {
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        const float* share = met.pixel(0, int(y));
        const float* shades = shade ? shade->pixel(0, int(y)) : nullptr;
        for (int x = 0; x < image.size.x; ++x, rgba += 4, share += 4) {
            FoundValue found;
            found.isMet = share[3] >= 0.5f;
            if (found.isMet) {
                found.value = rgba[3] / share[3];
                if (shades) found.shade = std::min(shades[4 * x + 3] / share[3], 1.0f);
            }
            painter.paint(found, rgba);
        }
    });
}

// A parallel picture on its way: what lies where, and what it is for.
struct ParallelView {
    const Volume& volume;
    const RenderOptions& options;
    const Camera& camera;
    const Factorization& factors;
};

// How deep along the line of sight places in the volume lie, counted from its first voxel; from one
// to the next.
glm::dvec3 depthSteps(const ParallelView& view) {
    const glm::dmat3 linear(view.volume.worldFromIndex);
    const glm::ivec3 order = sliceOrder(view.factors.sliceAxis);
    glm::dvec3 steps;
    for (int i = 0; i < 3; ++i) steps[i] = glm::dot(linear[order[i]], view.camera.direction);
    return steps;
}

DepthShade shadeOf(const ParallelView& view, const glm::dvec3& steps, const IndexBox& box) {
    DepthShade shade{view.options.depthShade, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
        const double way = steps[axis] * (box.dims()[axis] - 1);
        shade.nearest += std::min(way, 0.0);
        shade.farthest += std::max(way, 0.0);
    }
    return shade;
}

// Turns the slices that values are from into shades; nothing has none.
void shadePlaces(const ParallelView& view, const IndexBox& box, const SheetLayout& layout,
                 const BasePlane& basePlane, const RayPlane& met, RayPlane& places) {
    const glm::dvec3 steps = depthSteps(view);
    const DepthShade shade = shadeOf(view, steps, box);
    const glm::dvec2 first = layout.firstVoxel - glm::ivec2(box.min.z, box.min.y);
    const glm::ivec2 size = places.box.size();
    parallelFor(std::size_t(size.y), [&](std::size_t row) {
        float* out = &places.values[row * std::size_t(size.x)];
        const float* isMet = &met.values[row * std::size_t(size.x)];
        for (int x = 0; x < size.x; ++x) {
            const int slice = int(out[x]);
            const glm::ivec2 pixel(places.box.min.x + x, places.box.min.y + int(row));
            const glm::dvec2 at =
                first + basePlane.positionOf(pixel) + basePlane.placeOf(box.min.x + slice).offset;
            const double depth = glm::dot(steps, glm::dvec3(slice, at.y, at.x));
            out[x] = isMet[x] * shade.at(depth);
        }
    });
}

RayRule parallelRule(Mode mode) {
    if (mode == Mode::kMip) return RayRule::kMax;
    // Means are sums divided by counts.
    return mode == Mode::kMin ? RayRule::kMaxActive : RayRule::kSum;
}

void renderParallel(const ParallelView& view, const Listener& listener, RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const auto& [volume, options, camera, factors] = view;
    const RayRule rule = parallelRule(options.mode);
    const RayVolume rays = makeRayVolume(volume, factors.sliceAxis, rule, valueMapOf(options));
    RenderStats& stats = result.stats;
    stats.prepareSeconds = secondsSince(start);

    const Clock::time_point renderStart = Clock::now();
    const Footprint footprint =
        footprintOf(options, {factors.shiftPerSlice.y, factors.shiftPerSlice.x});
    const SheetLayout layout = layoutSheet(rays.box, footprint, 1);
    const BasePlane basePlane(factors, layout.firstSlice, layout.firstVoxel, layout.resolution,
                              layout.offsetPixels);
    const bool shades = options.mode == Mode::kMip && options.depthShade > 0;
    RayPlanes planes = followRays({rays, rule, layout, basePlane, shades}, listener);
    RayPlane& plane = planes.values;
    stats.visible = rays.visible;
    if (options.mode == Mode::kAverage) {
        const RayVolume ones =
            makeRayVolume(volume, factors.sliceAxis, rule, {.scale = 0, .offset = 1});
        divideByCounts(followRays({ones, rule, layout, basePlane}, listener).values, plane);
        stats.visible = ones.visible;
    }
    stats.splatSeconds = secondsSince(renderStart);

    const glm::dmat3& map = basePlane.pixelFromPicture();
    if (showsSums(options.mode)) {
        plane = blurPlane(plane, footprint, float(factors.sliceStepWorld));
        stats.compositeSeconds = secondsSince(renderStart) - stats.splatSeconds;
        warp(rasterOf(plane), map, WarpFilter::kSmooth, result.image);
    } else {
        const RayPlane met = splitMet(plane);
        if (shades) shadePlaces(view, rays.box, layout, basePlane, met, *planes.places);
        stats.compositeSeconds = secondsSince(renderStart) - stats.splatSeconds;
        Image share(result.image.size);
        Image shade(shades ? result.image.size : glm::ivec2(0));
        warp(rasterOf(met), map, WarpFilter::kLinear, share);
        if (shades) warp(rasterOf(*planes.places), map, WarpFilter::kLinear, shade);
        warp(rasterOf(plane), map, WarpFilter::kLinear, result.image);
        combineMet(share, shades ? &shade : nullptr, ValuePainter(volume, options, rays),
                   result.image);
    }
    stats.resolution = kResolution;
    stats.footprint = footprint.width;
    stats.renderSeconds = secondsSince(renderStart);
    stats.warpSeconds = stats.renderSeconds - stats.splatSeconds - stats.compositeSeconds;
}

bool isEmpty(const Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] != 0) return false;
    return true;
}

}  // namespace

void renderRays(const Volume& volume, const RenderOptions& options, const Listener& listener,
                RenderResult& result) {
    checkRayOptions(options);
    const bool parallel = options.camera.projection == Projection::kOrtho;
    // Of pictures from an eye, where it goes from region to region, the middle's.
    const Factorization view = factorize(result.camera, volume.worldFromIndex,
                                         parallel ? options.resolution : std::optional<double>(1));
    result.stats.sliceAxis = view.sliceAxis;
    result.stats.slices = volume.box.dims()[view.sliceAxis];
    if (!volume.empty()) {
        warnOfValues(volume, options, result.stats.slices, view.sliceStepWorld, listener);
        if (parallel) {
            renderParallel({volume, options, result.camera, view}, listener, result);
        } else {
            renderFromEye(volume, options, listener, result);
        }
        // Sums may be 0 of what is there.
        if (!showsSums(options.mode) && isEmpty(result.image))
            listener.warn(emptyPictureText(volume, "fills less than half of any pixel"));
    }
    if (options.mode == Mode::kDrr) showTransmission(options.drr, result.image);
}

}  // namespace deltasplat
