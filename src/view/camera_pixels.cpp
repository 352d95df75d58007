// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "deltasplat/view/camera.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

// On the plane through the target: from there to the right, and down.
glm::dvec2 offsetWorld(const Camera& camera, glm::dvec2 pixel) {
    return (pixel - camera.targetPixel()) *
           glm::dvec2(camera.pixelWorld(), camera.pixelHeightWorld());
}

}  // namespace

std::string projectionName(Projection projection) {
    switch (projection) {
        case Projection::kOrtho:
            return "ortho";
        case Projection::kPerspective:
            return "perspective";
        case Projection::kLatlong:
            return "latlong";
    }
    return "ortho";
}

double Camera::fovDegrees() const {
    return 360 / std::numbers::pi * portable::atan2(0.5 * frameHeightWorld(), targetDistanceWorld);
}

glm::dvec3 Camera::rayThrough(glm::dvec2 pixel) const {
    if (projection == Projection::kOrtho) return direction;
    if (projection == Projection::kPerspective) {
        const glm::dvec2 offset = offsetWorld(*this, pixel);
        return targetDistanceWorld * direction + offset.x * right - offset.y * up;
    }
    const double longitude = 2 * std::numbers::pi * (pixel.x / sizePixels.x - 0.5);
    const double latitude = std::numbers::pi * (0.5 - pixel.y / sizePixels.y);
    return portable::cos(latitude) *
               (portable::sin(longitude) * right + portable::cos(longitude) * direction) +
           portable::sin(latitude) * up;
}

glm::dvec3 Camera::worldFromPixel(glm::dvec2 pixel) const {
    if (projection == Projection::kLatlong)
        return eyeWorld() + targetDistanceWorld * rayThrough(pixel);
    const glm::dvec2 offset = offsetWorld(*this, pixel);
    return targetWorld + offset.x * right - offset.y * up;
}

glm::dvec2 Camera::pixelFromWorld(const glm::dvec3& world) const {
    glm::dvec3 offset = world - targetWorld;
    if (projection == Projection::kPerspective) {
        offset = world - eyeWorld();
        offset *= targetDistanceWorld / glm::dot(offset, direction);
    } else if (projection == Projection::kLatlong) {
        const glm::dvec3 ray = world - eyeWorld();
        const glm::dvec2 level(glm::dot(ray, direction), glm::dot(ray, right));
        const double longitude = portable::atan2(level.y, level.x);
        const double latitude =
            portable::atan2(glm::dot(ray, up), portable::hypot(level.x, level.y));
        return {sizePixels.x * (0.5 + longitude / (2 * std::numbers::pi)),
                sizePixels.y * (0.5 - latitude / std::numbers::pi)};
    }
    return targetPixel() + glm::dvec2(glm::dot(offset, right), -glm::dot(offset, up)) /
                               glm::dvec2(pixelWorld(), pixelHeightWorld());
}

// Based on: the OpenEXR project, "Standard Attributes" (worldToCamera, worldToNDC).
glm::dmat4 Camera::cameraFromWorld() const {
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, up, direction));
    glm::dmat4 matrix(rotation);
    matrix[3] = glm::dvec4(glm::dvec3(0, 0, targetDistanceWorld) - rotation * targetWorld, 1);
    return matrix + 0.0;  // no -0
}

glm::dmat4 Camera::ndcFromWorld() const {
    if (overscanPixels != glm::ivec2(0)) return withoutOverscan().ndcFromWorld();
    glm::dmat4 ndcFromCamera(1);
    if (projection == Projection::kPerspective) {
        // Homogeneous: the fourth number is z, by which the others are divided.
        ndcFromCamera[0][0] = targetDistanceWorld / frameWidthWorld;
        ndcFromCamera[1][1] = -targetDistanceWorld / frameHeightWorld();
        ndcFromCamera[2] = glm::dvec4(targetInFrame, 1, 1);
        ndcFromCamera[3] = glm::dvec4(0);
        return ndcFromCamera * cameraFromWorld() + 0.0;
    }
    ndcFromCamera[0][0] = 1 / frameWidthWorld;
    ndcFromCamera[1][1] = -1 / frameHeightWorld();
    ndcFromCamera[3] = glm::dvec4(targetInFrame, 0, 1);
    return ndcFromCamera * cameraFromWorld() + 0.0;
}

}  // namespace deltasplat
