// SPDX-License-Identifier: Apache-2.0
#include "shadow_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "unit_vector.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// Pixels of a side.
constexpr double kMostAcross = 2048;
constexpr double kLeastAcross = 4;
// Radii from which on light of a point is as good as parallel: it spreads by a ten-thousandth.
constexpr double kFar = 1e4;
// Sine of half the angle of view from which on a flat picture is stretched too much: 50 degrees.
constexpr double kWide = 0.766;

// The axis of a camera that is least parallel to a direction, turned perpendicular to it.
glm::dvec3 upOf(const glm::dvec3& direction, const Camera& axes) {
    glm::dvec3 best = axes.up;
    for (const glm::dvec3& axis : {axes.right, axes.direction})
        if (std::abs(glm::dot(axis, direction)) < 0.5 * std::abs(glm::dot(best, direction)))
            best = axis;
    return glm::normalize(best - glm::dot(best, direction) * direction);
}

// How far the box reaches from its middle, either way.
double reachAlong(const SeenBall& ball, const glm::dvec3& axis) {
    double reach = 0;
    for (const glm::dvec3& edge : ball.halfEdges) reach += std::abs(glm::dot(edge, axis));
    return reach;
}

}  // namespace

SeenBall::SeenBall(const Volume& volume) : voxel(smallestSize(volume)) {
    // Half of the last voxel, and what its footprint reaches beyond.
    constexpr double kBeyond = 1.5;
    const glm::dvec3 low(volume.box.min);
    const glm::dvec3 high(volume.box.max);
    middle = glm::dvec3(volume.worldFromIndex * glm::dvec4(0.5 * (low + high), 1));
    radius = 0;
    for (int axis = 0; axis < 3; ++axis) {
        halfEdges[axis] =
            (0.5 * (high[axis] - low[axis]) + kBeyond) * glm::dvec3(volume.worldFromIndex[axis]);
    }
    for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0})
            radius =
                std::max(radius, glm::length(halfEdges[0] + u * halfEdges[1] + v * halfEdges[2]));
    }
}

LightCamera::LightCamera(const Light& light, const SeenBall& ball, const Camera& axes)
    : ball_(ball) {
    camera_.direction = light.direction;
    if (light.positionWorld) {
        const glm::dvec3 away = ball.middle - *light.positionWorld;
        distance_ = glm::length(away);
        camera_.direction = distance_ > 0 ? away : -axes.up;
        if (distance_ < kFar * ball.radius) eye_ = light.positionWorld;
    }
    camera_.direction = unitVectorOf(camera_.direction);
    camera_.up = upOf(camera_.direction, axes);
    camera_.right = glm::cross(camera_.direction, camera_.up);
    camera_.targetWorld = ball.middle;
    if (!eye_) return;
    if (distance_ * kWide > ball.radius) {
        camera_.projection = Projection::kPerspective;
        camera_.targetDistanceWorld = distance_;
        return;
    }
    camera_.projection = Projection::kLatlong;
    distance_ = std::max(distance_, 0.5 * ball.radius);
    camera_.targetWorld = *eye_ + distance_ * camera_.direction;
    camera_.targetDistanceWorld = distance_;
}

double LightCamera::growthAt(const glm::dvec3& world) const {
    return eye_ ? glm::distance(*eye_, world) / distance_ : 1;
}

Camera LightCamera::of(double pixelWorld) const {
    Camera camera = camera_;
    if (camera.projection == Projection::kLatlong) {
        const double around = 2 * std::numbers::pi * distance_;
        const double rows =
            std::ceil(std::clamp(0.5 * around / pixelWorld, kLeastAcross, 0.5 * kMostAcross));
        camera.sizePixels = {2 * int(rows), int(rows)};
        camera.frameWidthWorld = around;
        return camera;
    }
    glm::dvec2 frame(2 * reachAlong(ball_, camera.right), 2 * reachAlong(ball_, camera.up));
    if (camera.projection == Projection::kPerspective) {
        // Of a cone around the ball.
        const double sine = ball_.radius / distance_;
        frame = glm::dvec2(2 * ball_.radius / std::sqrt(1 - sine * sine));
    }
    const double pixel = std::max(pixelWorld, std::max(frame.x, frame.y) / kMostAcross);
    const glm::dvec2 pixels = glm::clamp(glm::ceil(frame / pixel), kLeastAcross, kMostAcross);
    camera.sizePixels = glm::ivec2(pixels);
    camera.frameWidthWorld = pixel * pixels.x;
    return camera;
}

double alphaAt(const Image& image, const Camera& camera, const glm::dvec3& world) {
    const bool isRound = camera.projection == Projection::kLatlong;
    if (camera.projection == Projection::kPerspective &&
        !(glm::dot(world - camera.eyeWorld(), camera.direction) > 0))
        return 0;
    const glm::dvec2 place = camera.pixelFromWorld(world) - 0.5;
    const glm::dvec2 size(image.size);
    if (!(place.x > -1 && place.y > -1 && place.x < size.x && place.y < size.y)) return 0;
    const glm::dvec2 first = glm::floor(place);
    const glm::dvec2 share = place - first;
    const auto readAt = [&](int x, int y) -> double {
        if (isRound) {
            x = (x + image.size.x) % image.size.x;
            y = std::clamp(y, 0, image.size.y - 1);
        }
        const bool isIn = x >= 0 && y >= 0 && x < image.size.x && y < image.size.y;
        return isIn ? image.pixel(x, y)[3] : 0;
    };
    const glm::ivec2 at(first);
    const auto rowAt = [&](int y) {
        return (1 - share.x) * readAt(at.x, y) + share.x * readAt(at.x + 1, y);
    };
    return (1 - share.y) * rowAt(at.y) + share.y * rowAt(at.y + 1);
}

}  // namespace deltasplat
