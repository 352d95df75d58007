// SPDX-License-Identifier: Apache-2.0
// Based on: P. Lacroute and M. Levoy, Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation, 1994. Deviates in that the base plane is sampled at a whole number of
// points a voxel, and in that near-ties and near-zero shifts are snapped (see factorize).
#include "deltasplat/view/factorization.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>

#include "default_floats.h"
#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/error.h"
#include "portable_math.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// Directions this close are the same: rounding in a transform or an angle must neither choose the
// axis of a diagonal view nor tilt a straight one.
constexpr double kSnap = 1e-9;
// Beyond, footprints are so wide (defaultSigma) that more sheet pixels would show nothing else.
constexpr int kMaxAutomaticResolution = 2;

int mostParallelAxis(const glm::dvec3& direction) {
    const glm::dvec3 along = glm::abs(direction);
    const double largest = std::max({along.x, along.y, along.z});
    for (int axis = 2; axis > 0; --axis) {
        if (along[axis] >= largest * (1 - kSnap)) return axis;
    }
    return 0;
}

// One component of the shift, -1..1.
double snapped(double shift) {
    if (std::abs(shift) < kSnap) return 0;
    return std::abs(shift) > 1 - kSnap ? std::copysign(1.0, shift) : shift;
}

// Where an index vector, slid along the line of sight, meets the plane of slice 0.
glm::dvec2 onBasePlane(const glm::dvec3& index, const glm::ivec3& order, const glm::dvec2& shift) {
    return glm::dvec2(index[order[1]], index[order[2]]) + index[order[0]] * shift;
}

// The largest stretch of a 2x2 matrix is the root of the larger eigenvalue of its square.
double largestSingularValue(const glm::dmat2& m) {
    const double half = 0.5 * (glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]));
    const double difference = 0.5 * (glm::dot(m[0], m[0]) - glm::dot(m[1], m[1]));
    return std::sqrt(half + portable::hypot(difference, glm::dot(m[0], m[1])));
}

int screenResolution(double pixelsPerVoxel) {
    // Asked this way round because a frame too narrow for double arithmetic stretches by NaN.
    if (!(pixelsPerVoxel < kMaxAutomaticResolution)) return kMaxAutomaticResolution;
    return int(std::lround(std::max(pixelsPerVoxel, 1.0)));
}

void checkResolution(int resolution) {
    if (resolution >= 1 && resolution <= kMaxResolution) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("--resolution", std::to_string(resolution),
                            "a whole number within 1.." + std::to_string(kMaxResolution)));
}

}  // namespace

Factorization factorize(const Camera& camera, const glm::dmat4& worldFromIndex,
                        std::optional<int> resolution) {
    const DefaultFloats floats;
    if (resolution) checkResolution(*resolution);
    requireInvertible(worldFromIndex);
    const glm::dmat3 worldFromIndexLinear(worldFromIndex);
    const glm::dmat3 indexFromWorldLinear = glm::inverse(worldFromIndexLinear);

    // Choose the slices that the line of sight crosses most squarely, in index space.
    Factorization result;
    const glm::dvec3 direction = indexFromWorldLinear * camera.direction;
    result.sliceAxis = mostParallelAxis(direction);
    const glm::ivec3 order = sliceOrder(result.sliceAxis);
    const double perSlice = direction[order[0]];
    result.frontToBack = perSlice > 0;
    result.shiftPerSlice = {snapped(-direction[order[1]] / perSlice),
                            snapped(-direction[order[2]] / perSlice)};

    // One step of the line of sight to the next slice, as snapped.
    glm::dvec3 step(0);
    step[order[0]] = 1;
    step[order[1]] = -result.shiftPerSlice.x;
    step[order[2]] = -result.shiftPerSlice.y;
    result.sliceStepWorld = glm::length(worldFromIndexLinear * step);

    // Pixels go to the plane through the target, then along the line of sight to the base plane.
    const auto baseFromWorldVector = [&](const glm::dvec3& world) {
        return onBasePlane(indexFromWorldLinear * world, order, result.shiftPerSlice);
    };
    const double pixel = camera.pixelWorld();
    const glm::dvec3 topLeft = camera.worldFromPixel({0, 0}) - glm::dvec3(worldFromIndex[3]);
    result.baseFromPixel = {glm::dvec3(baseFromWorldVector(pixel * camera.right), 0),
                            glm::dvec3(baseFromWorldVector(-pixel * camera.up), 0),
                            glm::dvec3(baseFromWorldVector(topLeft), 1)};
    result.pixelsPerVoxel = largestSingularValue(glm::inverse(glm::dmat2(result.baseFromPixel)));
    result.resolution = resolution ? *resolution : screenResolution(result.pixelsPerVoxel);
    return result;
}

Factorization subdivided(const Factorization& view, const Subdivision& parts) {
    Factorization result = view;
    const double within = parts.within;
    result.shiftPerSlice *= within / parts.slices;
    result.sliceStepWorld /= parts.slices;
    result.pixelsPerVoxel /= within;
    // The first thin voxel lies before the middle of the one that it is a part of, on each axis.
    const glm::dvec2 first =
        0.5 * (within - 1) + within * (0.5 - 0.5 / parts.slices) * view.shiftPerSlice;
    const glm::dvec2 origin =
        glm::dvec2(parts.origin.y, parts.origin.z) + double(parts.origin.x) * view.shiftPerSlice;
    result.baseFromPixel[2] -= glm::dvec3(origin, 0);
    for (int column = 0; column < 3; ++column) {
        glm::dvec3& base = result.baseFromPixel[column];
        base = glm::dvec3(within * glm::dvec2(base), base.z);
    }
    result.baseFromPixel[2] += glm::dvec3(first, 0);
    return result;
}

}  // namespace deltasplat
