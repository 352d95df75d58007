// SPDX-License-Identifier: Apache-2.0
#include "view/camera_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

namespace {

constexpr double kLeastScale = 1e-30;
constexpr double kMostScale = 1e30;

bool isFinite(const glm::dmat4& matrix) {
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            if (!std::isfinite(matrix[i][j])) return false;
    }
    return true;
}

// Returns the fault, or nothing.
std::string faultOf(const glm::dmat4& matrix, const glm::dvec3& lengths) {
    if (!isFinite(matrix)) return "a number that is not finite";
    const glm::dvec4 last(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (last != glm::dvec4(0, 0, 0, 1)) {
        const bool isTransposed = last.w == 1 && glm::dvec3(matrix[3]) == glm::dvec3(0);
        if (isTransposed) return "the translation in the last column";
        return glm::determinant(matrix) == 0 ? "a singular matrix" : "a projection";
    }
    const double least = std::min({lengths.x, lengths.y, lengths.z});
    const double most = std::max({lengths.x, lengths.y, lengths.z});
    if (!(least >= kLeastScale && most <= kMostScale))
        return "axes of the lengths " + numberText(lengths);
    const glm::dmat3 unit(glm::dvec3(matrix[0]) / lengths.x, glm::dvec3(matrix[1]) / lengths.y,
                          glm::dvec3(matrix[2]) / lengths.z);
    const double volume = glm::determinant(unit);
    if (std::abs(volume) < kAxesRounding) return "a singular matrix";
    if (volume < 0) return "a mirrored one";
    const double cosine =
        std::max({std::abs(glm::dot(unit[0], unit[1])), std::abs(glm::dot(unit[1], unit[2])),
                  std::abs(glm::dot(unit[2], unit[0]))});
    if (cosine > kAxesRounding) return "axes that are not at right angles";
    if (most - least > kAxesRounding * most) return "axes of the lengths " + numberText(lengths);
    return "";
}

}  // namespace

CameraAxes cameraAxes(const glm::dmat4& worldFromCamera, const std::string& what, ErrorCode code) {
    glm::dvec3 lengths;
    for (int i = 0; i < 3; ++i) lengths[i] = glm::length(glm::dvec3(worldFromCamera[i]));
    const std::string fault = faultOf(worldFromCamera, lengths);
    if (!fault.empty()) {
        throw Error(code, gotExpected(what, fault,
                                      "a rotation, perhaps evenly scaled, and a translation in the "
                                      "last row, row by row"));
    }
    CameraAxes axes;
    // Adding 0 removes -0.
    axes.direction = 0.0 - glm::normalize(glm::dvec3(worldFromCamera[2]));
    const glm::dvec3 up(worldFromCamera[1]);
    axes.right = glm::normalize(glm::cross(axes.direction, up));
    axes.up = glm::cross(axes.right, axes.direction);
    axes.positionWorld = glm::dvec3(worldFromCamera[3]);
    axes.scale = (lengths.x + lengths.y + lengths.z) / 3;
    return axes;
}

namespace {

// On the plane through the target, relative to it: right and down.
glm::dvec2 offsetWorld(const Camera& camera, glm::dvec2 pixel) {
    return (pixel - camera.targetPixel()) *
           glm::dvec2(camera.pixelWorld(), camera.pixelHeightWorld());
}

}  // namespace

std::string projectionName(Projection projection) {
    return enumName(projection, {"ortho", "perspective", "latlong"});
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
        // Homogeneous: the other components are divided by the fourth, z.
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
