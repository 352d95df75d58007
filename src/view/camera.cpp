// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/view/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "number_text.h"
#include "portable_math.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// Both vectors in the space of who looks at the front: x to the right, y up, z towards the eye.
struct NamedView {
    const char* name;
    glm::dvec3 direction;
    glm::dvec3 up;
};

const NamedView kNamedViews[] = {
    {"front", {0, 0, -1}, {0, 1, 0}}, {"back", {0, 0, 1}, {0, 1, 0}},
    {"left", {1, 0, 0}, {0, 1, 0}},   {"right", {-1, 0, 0}, {0, 1, 0}},
    {"top", {0, -1, 0}, {0, 0, -1}},  {"bottom", {0, 1, 0}, {0, 0, 1}},
    {"iso", {-1, -1, -1}, {0, 1, 0}},
};

[[noreturn]] void refuse(const char* flag, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected(flag, got, expected));
}

const NamedView& namedView(const std::string& name) {
    std::string known;
    for (const NamedView& view : kNamedViews) {
        if (name == view.name) return view;
        known += (known.empty() ? "" : ", ") + std::string(view.name);
    }
    refuse("--view", name, "one of " + known);
}

// How who looks at the front of the volume stands in the world.
struct Viewer {
    glm::dmat3 worldFromViewer{1.0};
    bool facesPatient = false;

    // Sums with 0 have no -0.
    glm::dvec3 toWorld(const glm::dvec3& v) const { return worldFromViewer * v + 0.0; }
};

Viewer viewerOf(const std::string& space) {
    // The patient's left, head and front are at the right, above and nearer.
    if (space == "RAS") return {glm::dmat3(-1, 0, 0, 0, 0, 1, 0, 1, 0), true};
    if (space == "LPS") return {glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0), true};
    return {};
}

// The left of a patient who is faced is at the right.
std::string viewFrom(const Viewer& viewer, const std::string& view) {
    if (!viewer.facesPatient) return view;
    if (view == "left") return "right";
    return view == "right" ? "left" : view;
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Scales to length 1 without overflow on the way.
glm::dvec3 unitVector(const char* flag, const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!isFinite(v) || largest == 0) {
        refuse(flag, numberText(v), "three finite numbers, not all of them 0");
    }
    return glm::normalize(v / largest);
}

void checkNumber(const char* flag, double number) {
    if (!std::isfinite(number)) refuse(flag, numberText(number), "a finite number");
}

void checkOptions(const CameraOptions& options) {
    checkNumber("--azimuth", options.azimuthDegrees);
    checkNumber("--elevation", options.elevationDegrees);
    checkNumber("--roll", options.rollDegrees);
    if (options.targetWorld && !isFinite(*options.targetWorld)) {
        refuse("--target", numberText(*options.targetWorld), "three finite numbers");
    }
    const double width = options.frameWidthWorld.value_or(1);
    if (!std::isfinite(width) || width <= 0) {
        refuse("--frame-width", numberText(width), "a number > 0");
    }
    const glm::ivec2 size = options.sizePixels;
    if (size.x < 1 || size.y < 1) {
        refuse("--size", std::to_string(size.x) + "x" + std::to_string(size.y),
               "WxH, each at least 1");
    }
}

// Turns v about a unit axis by the right-hand rule (O. Rodrigues, 1840). Quarter turns are exact,
// so that a view turned by 90 degrees is as straight as a named one.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double degrees) {
    constexpr double kRadians = std::numbers::pi / 180;
    int quarters = 0;
    const double rest = std::remquo(degrees, 90.0, &quarters) * kRadians;
    const double cosines[] = {portable::cos(rest), -portable::sin(rest), -portable::cos(rest),
                              portable::sin(rest)};
    const double cosine = cosines[quarters & 3];
    const double sine = cosines[(quarters + 3) & 3];
    return v * cosine + glm::cross(axis, v) * sine + axis * (glm::dot(axis, v) * (1 - cosine));
}

// Sets the three axes as a person turns a camera that looks along `direction`, head towards `up`.
void orient(Camera& camera, const CameraOptions& options, const Viewer& viewer) {
    const NamedView& view = namedView(options.direction ? "front" : viewFrom(viewer, options.view));
    const glm::dvec3 givenUp = options.up.value_or(viewer.toWorld(view.up));
    const glm::dvec3 givenDirection = options.direction.value_or(viewer.toWorld(view.direction));
    const glm::dvec3 up = unitVector("--up", givenUp);
    glm::dvec3 direction = unitVector("--direction", givenDirection);
    if (glm::length(glm::cross(direction, up)) < 1e-9) {
        refuse(options.direction ? "--direction" : "--up",
               numberText(givenDirection) + " as direction, parallel to up " + numberText(givenUp),
               "directions that differ (another --view, --direction or --up)");
    }

    // The azimuth goes about the up that was given, the rest about the camera's own axes.
    direction = turned(direction, up, options.azimuthDegrees);
    camera.right = glm::normalize(glm::cross(direction, up));
    camera.direction = turned(direction, camera.right, -options.elevationDegrees);
    camera.right = turned(camera.right, camera.direction, options.rollDegrees);
    camera.up = glm::cross(camera.right, camera.direction);
}

glm::dvec3 transformed(const glm::dmat4& worldFromIndex, const glm::dvec3& index) {
    return glm::dvec3(worldFromIndex * glm::dvec4(index, 1));
}

// The narrowest frame of square pixels that holds the projected box both ways.
double fittingFrame(const Camera& camera, const IndexBox& box, const glm::dmat4& worldFromIndex) {
    const glm::dmat3 linear(worldFromIndex);
    const glm::dvec3 edges = glm::max(glm::dvec3(box.max) - glm::dvec3(box.min), 0.0);
    glm::dvec2 extent(0);
    double voxel = glm::length(linear[0]);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 edge = linear[axis] * edges[axis];
        extent +=
            glm::dvec2(std::abs(glm::dot(edge, camera.right)), std::abs(glm::dot(edge, camera.up)));
        voxel = std::min(voxel, glm::length(linear[axis]));
    }

    // A point, or a line seen end-on, is framed as one voxel; rounding may keep it from being zero.
    const double aspect = double(camera.sizePixels.x) / camera.sizePixels.y;
    const double width = std::max(extent.x, extent.y * aspect);
    return width > 1e-6 * voxel ? width : voxel;
}

// How far before the target the camera has to be for all voxels of the box to lie beyond it, edges
// and footprints included.
double clearDistance(const Camera& camera, const IndexBox& box, const glm::dmat4& worldFromIndex) {
    const glm::dmat3 linear(worldFromIndex);
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    double distance =
        glm::dot(camera.targetWorld - transformed(worldFromIndex, middle), camera.direction);
    for (int axis = 0; axis < 3; ++axis) {
        const double halfEdge = 0.5 * (double(box.max[axis]) - box.min[axis]) + 1;
        distance += halfEdge * std::abs(glm::dot(linear[axis], camera.direction));
    }
    return distance;
}

}  // namespace

glm::dvec3 Camera::worldFromPixel(glm::dvec2 pixel) const {
    const glm::dvec2 offset = (pixel - 0.5 * glm::dvec2(sizePixels)) * pixelWorld();
    return targetWorld + offset.x * right - offset.y * up;
}

glm::dvec2 Camera::pixelFromWorld(const glm::dvec3& world) const {
    const glm::dvec3 offset = world - targetWorld;
    return 0.5 * glm::dvec2(sizePixels) +
           glm::dvec2(glm::dot(offset, right), -glm::dot(offset, up)) / pixelWorld();
}

// Based on: the OpenEXR project, "Standard Attributes" (worldToCamera, worldToNDC).
glm::dmat4 Camera::cameraFromWorld() const {
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, up, direction));
    glm::dmat4 matrix(rotation);
    matrix[3] = glm::dvec4(glm::dvec3(0, 0, targetDistanceWorld) - rotation * targetWorld, 1);
    return matrix;
}

glm::dmat4 Camera::ndcFromWorld() const {
    const double frameHeightWorld = frameWidthWorld * sizePixels.y / sizePixels.x;
    glm::dmat4 ndcFromCamera(1);
    ndcFromCamera[0][0] = 1 / frameWidthWorld;
    ndcFromCamera[1][1] = -1 / frameHeightWorld;
    ndcFromCamera[3] = glm::dvec4(0.5, 0.5, 0, 1);
    return ndcFromCamera * cameraFromWorld();
}

Camera makeCamera(const CameraOptions& options, const IndexBox& box,
                  const glm::dmat4& worldFromIndex, const std::string& space) {
    const DefaultFloats floats;
    checkOptions(options);
    requireInvertible(worldFromIndex);
    const IndexBox framed = box.empty() ? IndexBox{glm::ivec3(0), glm::ivec3(0)} : box;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(framed.min) + glm::dvec3(framed.max));

    Camera camera;
    camera.sizePixels = options.sizePixels;
    orient(camera, options, viewerOf(space));
    camera.targetWorld = options.targetWorld.value_or(transformed(worldFromIndex, middle));
    camera.frameWidthWorld =
        options.frameWidthWorld.value_or(fittingFrame(camera, framed, worldFromIndex));
    camera.targetDistanceWorld = clearDistance(camera, framed, worldFromIndex);
    return camera;
}

}  // namespace deltasplat
