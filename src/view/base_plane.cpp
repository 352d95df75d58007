// SPDX-License-Identifier: Apache-2.0
// Based on: Philippe Lacroute and Marc Levoy, "Fast Volume Rendering Using a Shear-Warp
// Factorization of the Viewing Transformation", 1994; perspective scales slices as well as shifting
// them. Deviates in that the base plane is one of slopes, so a slice's scale is its distance from
// the eye.
#include "view/base_plane.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <vector>

#include "base/opacity_steps.h"
#include "base/parallel.h"
#include "view/factorization.h"

namespace deltasplat {

namespace {

glm::dvec2 swapped(glm::dvec2 v) {
    return {v.y, v.x};
}

}  // namespace

int planeBorder(const Factorization& view, double spacing) {
    constexpr double kLeast = 8;
    constexpr double kMost = 512;
    // Half as much again, because some pixels show more slopes than the average.
    constexpr double kReach = 3.2;
    return int(std::clamp(std::ceil(kReach / (spacing * view.pixelsPerSlope)), kLeast, kMost));
}

BasePlane::BasePlane(const Factorization& view, int firstSlice, glm::ivec2 firstVoxel,
                     double resolution, double offsetPixels)
    : frontToBack_(view.frontToBack),
      firstSlice_(firstSlice),
      spacing_(1.0 / resolution),
      origin_(offsetPixels / resolution),
      shiftPerSlice_(swapped(view.shiftPerSlice)) {
    const glm::dvec2 first = glm::dvec2(firstVoxel) + double(firstSlice) * shiftPerSlice_;
    glm::dmat3 relative = glm::dmat3(0, 1, 0, 1, 0, 0, 0, 0, 1) * view.baseFromPixel;
    relative[2] -= glm::dvec3(first, 0);
    const double r = resolution;
    pixelFromPicture_ = glm::dmat3(r, 0, 0, 0, r, 0, -offsetPixels, -offsetPixels, 1) * relative;
}

BasePlane::BasePlane(const Factorization& view, const Camera& camera, int firstSlice,
                     glm::ivec2 firstVoxel, double spacing)
    : frontToBack_(view.frontToBack),
      firstSlice_(firstSlice),
      spacing_(spacing),
      origin_(spacing *
              (glm::floor(swapped(view.slopeMin) / spacing) - double(planeBorder(view, spacing)))),
      eye_(glm::dvec3(view.eye->x - firstSlice, view.eye->z - firstVoxel.x,
                      view.eye->y - firstVoxel.y)),
      worldFromStep_(view.worldFromStep[0], view.worldFromStep[2], view.worldFromStep[1]),
      stepWorld_(view.sliceStepWorld * view.steps),
      nearWorld_(camera.nearWorld) {
    const glm::dvec2 wide = (swapped(view.slopeMax) - origin_) / spacing;
    // Allocating memory for too many pixels fails later.
    constexpr double kMost = 1 << 30;
    limits_.max = glm::ivec2(glm::min(glm::ceil(wide), kMost)) + planeBorder(view, spacing) + 1;
    if (camera.projection == Projection::kPerspective) depthAlong_ = camera.direction;
    // Depth is linear in slopes, so extremes are at corners.
    nearest_ = {std::numeric_limits<double>::infinity(), 0};
    for (int corner = 0; corner < 4; ++corner) {
        const double nearest = nearestOf({corner & 1 ? view.slopeMax.y : view.slopeMin.y,
                                          corner & 2 ? view.slopeMax.x : view.slopeMin.x});
        nearest_ = {std::min(nearest_.x, nearest), std::max(nearest_.y, nearest)};
    }
    // Depth along each line of sight: the line straight ahead crosses the most slices.
    if (!depthAlong_) nearest_.y = nearWorld_ / view.sliceStepWorld;
}

SlicePlace BasePlane::placeOf(int slice) const {
    const double slices = double(slice) - double(firstSlice_);
    if (!eye_) return {1, -(shiftPerSlice_ * slices)};
    // A slice that the eye cuts is placed at the middle of the rest.
    const double from = std::max(distanceOf(slice) - 0.5, nearest_.x);
    const double distance = 0.5 * (from + distanceOf(slice) + 0.5);
    return {distance, {eye_->y, eye_->z}};
}

double BasePlane::distanceOf(int slice) const {
    const double away = double(slice) - double(firstSlice_) - eye_->x;
    return frontToBack_ ? away : -away;
}

glm::ivec2 BasePlane::seen(glm::ivec2 slices) const {
    // A slice is visible if it ends, half a slice behind its middle, beyond the nearest depth.
    const double least = nearest_.x - 0.5;
    if (!(least < std::numeric_limits<double>::infinity())) return {slices.x, slices.x - 1};
    if (frontToBack_) {
        const double first = std::floor(firstSlice_ + eye_->x + least) + 1;
        if (first > slices.x) slices.x = int(std::min(first, double(slices.y) + 1));
    } else {
        const double last = std::ceil(firstSlice_ + eye_->x - least) - 1;
        if (last < slices.y) slices.y = int(std::max(last, double(slices.x) - 1));
    }
    return slices;
}

bool BasePlane::isCut(int slice) const {
    return distanceOf(slice) - 0.5 < nearest_.y;
}

bool BasePlane::cutsAny(glm::ivec2 slices) const {
    slices = seen(slices);
    return slices.x <= slices.y && isCut(frontToBack_ ? slices.x : slices.y);
}

double BasePlane::nearestOf(glm::dvec2 slope) const {
    if (nearWorld_ == 0) return 0;
    const glm::dvec3 ray = rayOf(slope);
    const double depth = depthAlong_ ? glm::dot(ray, *depthAlong_) : glm::length(ray);
    return depth > 0 ? nearWorld_ / depth : std::numeric_limits<double>::infinity();
}

double BasePlane::shareOf(int slice, glm::ivec2 pixel) const {
    const double end = distanceOf(slice) + 0.5;
    return std::clamp(end - nearestOf(positionOf(pixel)), 0.0, 1.0);
}

double BasePlane::stepsAt(glm::ivec2 pixel) const {
    return glm::length(rayOf(positionOf(pixel))) / stepWorld_;
}

StepLengths::StepLengths(const BasePlane& plane, const PlaneBox& planeBox,
                         std::pmr::memory_resource& memory)
    : box(planeBox),
      values(std::size_t(box.size().x) * std::size_t(box.size().y) + kStepsSpare, &memory) {
    parallelForChunks(std::size_t(box.size().y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            float* steps = &values[row * std::size_t(box.size().x)];
            for (int x = box.min.x; x < box.max.x; ++x)
                *steps++ = float(plane.stepsAt({x, box.min.y + int(row)}));
        }
    });
}

namespace {

// Rounding error of a sum of a few shifts.
constexpr double kSame = 1e-12;

double partOf(double x) {
    return x - std::floor(x);
}

// Returns the start of the shortest interval of the unit circle that contains all fractional parts:
// the end of the widest gap. Prefers 0 among equals.
double beginOfShortest(double shift, int count) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i) places.push_back(partOf(i * shift));
    std::sort(places.begin(), places.end());
    double begin = 0;
    double widest = 1 - places.back();
    for (std::size_t i = 1; i < places.size(); ++i) {
        const double gap = places[i] - places[i - 1];
        if (gap <= widest + kSame) continue;
        widest = gap;
        begin = places[i];
    }
    return begin;
}

}  // namespace

JoinedSlants joinedSlants(const glm::dvec2& shiftPerSlice, int count, int within) {
    JoinedSlants joined;
    glm::dvec2 range(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        const double whole = std::abs(shiftPerSlice[axis]);
        const double shift = whole * (1 - kSnap);
        const double begin = beginOfShortest(shift, count);
        const auto wholeOf = [&](int i) { return int(std::floor(i * shift - begin + kSame)); };
        double least = 0;
        double most = 0;
        for (int i = 1; i < count; ++i) {
            const int slant = wholeOf(i) - wholeOf(0);
            joined.slants[std::size_t(i)][axis] = shiftPerSlice[axis] < 0 ? -slant : slant;
            least = std::min(least, i * whole - slant);
            most = std::max(most, i * whole - slant);
        }
        range[axis] = most - least;
        // Otherwise only reading shows what lies beside a joined voxel. Reading takes more of it
        // the farther slices are off: up to a tenth with four, a fifth with eight.
        constexpr double kHardly = 0.2;
        const bool goesOn = count * shift >= within || (count - 1) * shift <= kHardly;
        joined.keepsDensity = joined.keepsDensity && goesOn;
    }
    joined.farthest = 0.5 * glm::length(range);
    return joined;
}

glm::dvec2 middleOfJoined(const glm::dvec2& shiftPerSlice, std::span<const glm::ivec2> slants) {
    glm::dvec2 least(0.0);
    glm::dvec2 most(0.0);
    for (std::size_t i = 1; i < slants.size(); ++i) {
        const glm::dvec2 place = double(i) * shiftPerSlice - glm::dvec2(slants[i]);
        least = glm::min(least, place);
        most = glm::max(most, place);
    }
    return 0.5 * (least + most);
}

SliceDepths::SliceDepths(const Camera& camera, const glm::dmat4& worldFromSlices)
    : camera_(camera), origin_(worldFromSlices[3]) {
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(worldFromSlices));
    slicesPerWorld_ = {inverse[0][0], inverse[1][0], inverse[2][0]};
    if (camera.projection != Projection::kOrtho) rays_.emplace(camera, glm::dmat3(1));
}

DepthLine SliceDepths::lineAt(int x, int y) const {
    glm::dvec3 ray = camera_.direction;
    glm::dvec3 start = camera_.eyeWorld();
    if (rays_) {
        ray = rays_->at(x, y);
    } else {
        start += camera_.worldFromPixel({x + 0.5, y + 0.5}) - camera_.targetWorld;
    }
    const bool isPanorama = camera_.projection == Projection::kLatlong;
    const double depth = isPanorama ? glm::length(ray) : glm::dot(ray, camera_.direction);
    DepthLine line;
    line.perSlice = depth / glm::dot(slicesPerWorld_, ray);
    line.first = glm::dot(slicesPerWorld_, origin_ - start) * line.perSlice;
    return line;
}

}  // namespace deltasplat
