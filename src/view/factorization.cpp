// SPDX-License-Identifier: Apache-2.0
// Based on: P. Lacroute and M. Levoy, Fast Volume Rendering Using a Shear-Warp Factorization of the
// Viewing Transformation, 1994. Deviates in that the base plane has a whole number of points per
// voxel or of voxels per point, and in that near-ties and near-zero shifts are snapped (see
// factorize).
#include "view/factorization.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <numbers>
#include <string>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "deltasplat/view/factorization.h"
#include "view/base_plane.h"

namespace deltasplat {

namespace {

// Above this, footprints are so wide (defaultSigma) that more sheet pixels make no difference.
constexpr int kMaxAutomaticResolution = 2;

// Returns a matrix's columns in slice order, the first away from the camera.
glm::dmat3 stepsOf(const glm::dmat3& linear, const glm::ivec3& order, bool frontToBack) {
    return {frontToBack ? linear[order[0]] : -linear[order[0]], linear[order[1]], linear[order[2]]};
}

double snapped(double shift) {
    if (std::abs(shift) < kSnap) return 0;
    return std::abs(shift) > 1 - kSnap ? std::copysign(1.0, shift) : shift;
}

// Projects an index vector along the line of sight to the plane of slice 0.
glm::dvec2 onBasePlane(const glm::dvec3& index, const glm::ivec3& order, const glm::dvec2& shift) {
    return glm::dvec2(index[order[1]], index[order[2]]) + index[order[0]] * shift;
}

// The root of the larger eigenvalue of the squared matrix.
double largestSingularValue(const glm::dmat2& m) {
    const double half = 0.5 * (glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]));
    const double difference = 0.5 * (glm::dot(m[0], m[0]) - glm::dot(m[1], m[1]));
    return std::sqrt(half + portable::hypot(difference, glm::dot(m[0], m[1])));
}

double screenResolution(double pixelsPerVoxel) {
    // Negated, because a frame too narrow for doubles stretches by NaN.
    if (!(pixelsPerVoxel < kMaxAutomaticResolution)) return kMaxAutomaticResolution;
    return double(std::lround(std::max(pixelsPerVoxel, 1.0)));
}

void requireFinite(const glm::dvec3& eye) {
    if (std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z)) return;
    throw Error(ErrorCode::kUsage, "`eyeWorld`", "voxel index " + numberText(eye),
                "a place that numbers can hold");
}

void checkResolution(double resolution) {
    if (isResolution(resolution)) return;
    throw Error(ErrorCode::kUsage, "`resolution`", numberText(resolution),
                "a whole number within 1.." + std::to_string(kMaxResolution));
}

// Lines of sight of one axis, steps (away, u, v): one per corner of the axis' part of the picture.
using Cone = std::vector<glm::dvec3>;

// Clips at a plane through the eye (I. Sutherland and G. Hodgman, 1974).
Cone clipped(const Cone& cone, const glm::dvec3& inward) {
    Cone inside;
    for (std::size_t i = 0; i < cone.size(); ++i) {
        const glm::dvec3& here = cone[i];
        const glm::dvec3& next = cone[(i + 1) % cone.size()];
        const double a = glm::dot(here, inward);
        const double b = glm::dot(next, inward);
        if (a >= 0) inside.push_back(here);
        if ((a < 0) != (b < 0)) inside.push_back(here + (a / (a - b)) * (next - here));
    }
    return inside;
}

// A range of slopes along u and v.
struct SlopeBox {
    glm::dvec2 least{-1.0};
    glm::dvec2 most{1.0};
};

SlopeBox slopesNear(const glm::ivec2& slopeStep) {
    const glm::dvec2 middle(slopeStep);
    return {glm::max(middle - 0.5, -1.0), glm::min(middle + 0.5, 1.0)};
}

// Returns the visible lines of sight with certain slopes along an axis.
Cone coneOf(const Camera& camera, const glm::dmat3& stepFromWorld, const SlopeBox& slopes) {
    const auto& [least, most] = slopes;
    const Cone whole = {
        {1, least.x, least.y}, {1, most.x, least.y}, {1, most.x, most.y}, {1, least.x, most.y}};
    if (camera.projection == Projection::kLatlong) return whole;
    Cone cone;
    const glm::dvec2 size(camera.sizePixels);
    for (const glm::dvec2& corner :
         {glm::dvec2(0), glm::dvec2(size.x, 0), size, glm::dvec2(0, size.y)})
        cone.push_back(stepFromWorld * camera.rayThrough(corner));
    for (const glm::dvec3& inward : {glm::dvec3(-least.x, 1, 0), glm::dvec3(most.x, -1, 0),
                                     glm::dvec3(-least.y, 0, 1), glm::dvec3(most.y, 0, -1)})
        cone = clipped(cone, inward);
    // Drops points that do not lead away, and parts that only touch a border.
    std::erase_if(cone, [](const glm::dvec3& ray) { return !(ray.x > 0); });
    return cone;
}

// Returns picture pixels per unit of slope, in the densest direction.
double densityAt(const Camera& camera, const glm::dmat3& worldFromStep, glm::dvec2 slope) {
    const glm::dvec3 ray = worldFromStep * glm::dvec3(1, slope);
    glm::dvec3 across[2];
    double pixels;
    if (camera.projection == Projection::kLatlong) {
        // On a sphere around the eye.
        pixels = camera.sizePixels.x / (2 * std::numbers::pi * glm::length(ray));
        const glm::dvec3 unit = glm::normalize(ray);
        for (int i = 0; i < 2; ++i)
            across[i] = worldFromStep[i + 1] - unit * glm::dot(unit, worldFromStep[i + 1]);
    } else {
        // On the picture's plane.
        const double depth = glm::dot(ray, camera.direction);
        pixels = camera.targetDistanceWorld / camera.pixelWorld() / depth;
        for (int i = 0; i < 2; ++i) {
            const glm::dvec3& step = worldFromStep[i + 1];
            const glm::dvec3 moved = step - ray * (glm::dot(step, camera.direction) / depth);
            across[i] = {glm::dot(moved, camera.right),
                         glm::dot(moved, camera.up) * camera.pixelAspect, 0};
        }
    }
    const double a = glm::dot(across[0], across[0]);
    const double b = glm::dot(across[1], across[1]);
    const double mixed = glm::dot(across[0], across[1]);
    return pixels * std::sqrt(0.5 * (a + b) + portable::hypot(0.5 * (a - b), mixed));
}

// Returns the slope of a cone's corner. Clamps rounding errors to the axis' range.
glm::dvec2 slopeOf(const glm::dvec3& ray) {
    return glm::clamp(glm::dvec2(ray.y, ray.z) / ray.x, -1.0, 1.0);
}

SlopeBox slopesOf(const Cone& cone) {
    SlopeBox slopes{slopeOf(cone.front()), slopeOf(cone.front())};
    for (const glm::dvec3& ray : cone) {
        slopes.least = glm::min(slopes.least, slopeOf(ray));
        slopes.most = glm::max(slopes.most, slopeOf(ray));
    }
    return slopes;
}

// Returns the shortest step along a slope of a box.
double shortestStep(const glm::dmat3& worldFromStep, const SlopeBox& slopes) {
    const glm::dvec3 &ahead = worldFromStep[0], &u = worldFromStep[1], &v = worldFromStep[2];
    // The square grows away from its minimum, so the shortest is there or beside it on an edge.
    const auto best = [](const glm::dvec3& base, const glm::dvec3& along, double least,
                         double most) {
        const double slope = -glm::dot(base, along) / glm::dot(along, along);
        return glm::length(base + std::clamp(slope, least, most) * along);
    };
    const glm::dmat2 squares(glm::dot(u, u), glm::dot(u, v), glm::dot(u, v), glm::dot(v, v));
    const glm::dvec2 inside =
        -(glm::inverse(squares) * glm::dvec2(glm::dot(ahead, u), glm::dot(ahead, v)));
    if (inside == glm::clamp(inside, slopes.least, slopes.most))
        return glm::length(ahead + inside.x * u + inside.y * v);
    return std::min({best(ahead + slopes.least.x * u, v, slopes.least.y, slopes.most.y),
                     best(ahead + slopes.most.x * u, v, slopes.least.y, slopes.most.y),
                     best(ahead + slopes.least.y * v, u, slopes.least.x, slopes.most.x),
                     best(ahead + slopes.most.y * v, u, slopes.least.x, slopes.most.x)});
}

double longestStep(const glm::dmat3& worldFromStep, const SlopeBox& slopes) {
    double longest = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec3 step(1, corner & 1 ? slopes.most.x : slopes.least.x,
                              corner & 2 ? slopes.most.y : slopes.least.y);
        longest = std::max(longest, glm::length(worldFromStep * step));
    }
    return longest;
}

// Returns the picture's mean density of slopes over corners and middle.
double densityOf(const Camera& camera, const Cone& cone, const glm::dmat3& worldFromStep) {
    glm::dvec2 sum(0);
    double logarithms = 0;
    const auto measure = [&](glm::dvec2 slope) {
        logarithms += portable::log(densityAt(camera, worldFromStep, slope));
    };
    for (const glm::dvec3& ray : cone) {
        sum += slopeOf(ray);
        measure(slopeOf(ray));
    }
    measure(sum / double(cone.size()));
    return portable::exp(logarithms / double(cone.size() + 1));
}

// Returns picture pixels per voxel at the volume's middle; inside of it, at the nearest face.
double pixelsAtMiddle(const Camera& camera, const IndexBox& box, const glm::dmat3& linear,
                      const glm::dvec3& eye) {
    const glm::dvec3 away = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)) - eye;
    const int axis = mostParallelAxis(away);
    const glm::ivec3 order = sliceOrder(axis);
    const glm::dvec3 half = 0.5 * glm::dvec3(glm::max(box.dims(), 1));
    const bool isInside = all(glm::lessThan(glm::abs(away), half));
    const double slices =
        isInside ? std::max(std::abs(away[axis]), half[axis]) : std::abs(away[axis]);
    const glm::dmat3 steps = stepsOf(linear, order, away[axis] > 0);
    const glm::dvec2 slope = glm::dvec2(away[order[1]], away[order[2]]) / slices;
    // If the volume lies behind, along the picture's middle line of sight.
    const bool isAhead = camera.projection == Projection::kLatlong ||
                         glm::dot(steps * glm::dvec3(1, slope), camera.direction) > 0;
    const double finePixel = std::min(camera.pixelWorld(), camera.pixelHeightWorld());
    return (isAhead ? densityAt(camera, steps, slope) : camera.targetDistanceWorld / finePixel) /
           slices;
}

}  // namespace

bool isResolution(double resolution) {
    return resolution >= 1 && resolution <= kMaxResolution && resolution == std::floor(resolution);
}

Factorization factorize(const Camera& camera, const glm::dmat4& worldFromIndex,
                        std::optional<double> resolution) {
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

    // One snapped step of the line of sight to the next slice.
    glm::dvec3 step(0);
    step[order[0]] = 1;
    step[order[1]] = -result.shiftPerSlice.x;
    step[order[2]] = -result.shiftPerSlice.y;
    result.sliceStepWorld = glm::length(worldFromIndexLinear * step);

    // Pixels go to the plane through the target, then along the line of sight to the base plane.
    const auto baseFromWorldVector = [&](const glm::dvec3& world) {
        return onBasePlane(indexFromWorldLinear * world, order, result.shiftPerSlice);
    };
    const glm::dvec3 topLeft = camera.worldFromPixel({0, 0}) - glm::dvec3(worldFromIndex[3]);
    result.baseFromPixel = {
        glm::dvec3(baseFromWorldVector(camera.pixelWorld() * camera.right), 0),
        glm::dvec3(baseFromWorldVector(-camera.pixelHeightWorld() * camera.up), 0),
        glm::dvec3(baseFromWorldVector(topLeft), 1)};
    result.pixelsPerVoxel = largestSingularValue(glm::inverse(glm::dmat2(result.baseFromPixel)));
    result.resolution = resolution ? *resolution : screenResolution(result.pixelsPerVoxel);
    return result;
}

double planeDistance(const glm::dmat4& worldFromIndex, int sliceAxis) {
    const glm::dmat3 linear(worldFromIndex);
    const glm::ivec3 order = sliceOrder(sliceAxis);
    const glm::dvec3 normal = glm::normalize(glm::cross(linear[order[1]], linear[order[2]]));
    return std::abs(glm::dot(linear[sliceAxis], normal));
}

std::vector<Factorization> factorizeRegions(const Camera& camera, const IndexBox& box,
                                            const glm::dmat4& worldFromIndex,
                                            std::optional<double> resolution, bool atSlopeSteps) {
    const DefaultFloats floats;
    if (resolution) checkResolution(*resolution);
    requireInvertible(worldFromIndex);
    const glm::dmat3 linear(worldFromIndex);
    const glm::dmat3 inverse = glm::inverse(linear);
    const glm::dvec3 eye = inverse * (camera.eyeWorld() - glm::dvec3(worldFromIndex[3]));
    requireFinite(eye);
    const double pixels = pixelsAtMiddle(camera, box, linear, eye);
    const Camera frame = camera.withoutOverscan();
    std::vector<Factorization> regions;
    const auto add = [&](Factorization region) {
        const SlopeBox all = region.slopeStep ? slopesNear(*region.slopeStep) : SlopeBox();
        const glm::dmat3 stepFromWorld = glm::inverse(region.worldFromStep);
        const Cone cone = coneOf(camera, stepFromWorld, all);
        if (cone.size() < 3) return;
        const SlopeBox slopes = slopesOf(cone);
        region.slopeMin = glm::clamp(slopes.least, all.least, all.most);
        region.slopeMax = glm::clamp(slopes.most, all.least, all.most);
        // The picture within the frame must not depend on overscan.
        const Cone ofFrame = coneOf(frame, stepFromWorld, all);
        const Cone& shown = ofFrame.size() < 3 ? cone : ofFrame;
        region.pixelsPerSlope = densityOf(camera, shown, region.worldFromStep);
        if (region.slopeStep) {
            const double least = shortestStep(region.worldFromStep, slopesOf(shown));
            const double most = longestStep(region.worldFromStep, slopesOf(shown));
            region.steps = std::sqrt(least * most) / region.sliceStepWorld;
            if (ofFrame.size() >= 3) region.stepRange = std::sqrt(most / least);
        }
        regions.push_back(region);
    };
    for (int axis = 2; axis >= 0; --axis) {
        const glm::ivec3 order = sliceOrder(axis);
        for (const bool frontToBack : {true, false}) {
            Factorization region;
            region.sliceAxis = axis;
            region.frontToBack = frontToBack;
            region.worldFromStep = stepsOf(linear, order, frontToBack);
            region.sliceStepWorld = planeDistance(worldFromIndex, axis);
            region.eye = glm::dvec3(eye[order[0]], eye[order[1]], eye[order[2]]);
            region.pixelsPerVoxel = pixels;
            region.resolution = resolution ? *resolution : screenResolution(pixels);
            if (!atSlopeSteps) {
                add(region);
                continue;
            }
            for (region.slopeStep.emplace().x = -1; region.slopeStep->x <= 1; ++region.slopeStep->x)
                for (region.slopeStep->y = -1; region.slopeStep->y <= 1; ++region.slopeStep->y)
                    add(region);
        }
    }
    return regions;
}

double mostPixelsOf(double lengthWorld, const Camera& camera, const IndexBox& box,
                    const glm::dmat4& worldFromIndex) {
    const glm::dvec3 first = glm::dvec3(box.min) - 0.5;
    const glm::dvec3 last = glm::dvec3(box.max) + 0.5;
    const auto world = [&](const glm::dvec3& index) {
        return glm::dvec3(worldFromIndex * glm::dvec4(index, 1));
    };
    const glm::dvec3 middle = world(0.5 * (first + last));
    const bool isPanorama = camera.projection == Projection::kLatlong;
    double nearest = std::numeric_limits<double>::infinity();  // along the middle line of sight
    double radius = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = world({corner & 1 ? last.x : first.x, corner & 2 ? last.y : first.y,
                                     corner & 4 ? last.z : first.z});
        nearest = std::min(nearest, glm::dot(at - camera.eyeWorld(), camera.direction));
        radius = std::max(radius, glm::length(at - middle));
    }
    double pixels = 0;  // of length 1 at distance 1
    if (isPanorama) {
        nearest = glm::length(middle - camera.eyeWorld()) - radius;
        pixels = camera.sizePixels.x / (2 * std::numbers::pi);
    } else {
        // Oblique lengths cover pixels, too. The frame's picture must not depend on overscan.
        const Camera frame = camera.withoutOverscan();
        double aside = 1;
        for (int corner = 0; corner < 4; ++corner) {
            const glm::dvec2 share(corner & 1, corner >> 1);
            const glm::dvec3 ray = frame.rayThrough(share * glm::dvec2(frame.sizePixels));
            aside = std::max(aside, glm::length(ray) / glm::dot(ray, camera.direction));
        }
        const double finest = std::min(camera.pixelWorld(), camera.pixelHeightWorld());
        pixels = aside * camera.targetDistanceWorld / finest;
    }
    return nearest > camera.nearWorld ? lengthWorld * pixels / nearest
                                      : std::numeric_limits<double>::infinity();
}

namespace {

// For an eye. Slopes change their unit if slices and voxels are divided differently.
Factorization subdividedFromEye(const Factorization& view, const Subdivision& parts) {
    Factorization result = view;
    const glm::dvec3 per = parts.per();
    // Joined voxels are counted from the first, and lie in the middle of both.
    result.eye = (*view.eye - glm::dvec3(parts.origin)) * per + 0.5 * (per - 1.0) +
                 0.5 * glm::dvec3(0, parts.slants[1]);
    for (int axis = 0; axis < 3; ++axis) result.worldFromStep[axis] /= per[axis];
    const double slopes = per.y / per.x;
    result.slopeLimit *= slopes;
    result.slopeMin *= slopes;
    result.slopeMax *= slopes;
    result.pixelsPerSlope /= slopes;
    result.sliceStepWorld /= per.x;
    result.pixelsPerVoxel /= per.y;
    return result;
}

}  // namespace

Factorization subdivided(const Factorization& view, const Subdivision& parts) {
    if (view.eye) return subdividedFromEye(view, parts);
    Factorization result = view;
    const double within = parts.per().y;
    const double slices = parts.per().x;
    result.shiftPerSlice *= within / slices;
    result.sliceStepWorld /= slices;
    result.pixelsPerVoxel /= within;
    // The first thin voxel lies before its voxel's centre, the first joined one before the middle.
    const glm::dvec2 alongSlices = parts.joined > 1
                                       ? -middleOfJoined(view.shiftPerSlice, parts.joinedSlants())
                                       : (0.5 - 0.5 / slices) * view.shiftPerSlice;
    const glm::dvec2 first = 0.5 * (within - 1) + within * alongSlices;
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
