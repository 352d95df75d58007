// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/view/camera.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "view/camera_axes.h"

namespace deltasplat {

namespace {

/// Checks options singly and in combination.
/// @throw Error(kUsage)
void checkCameraOptions(const CameraOptions& options);

[[noreturn]] void refuseCamera(const char* option, const std::string& got,
                               const std::string& expected);

bool isFinite(const glm::dvec3& v);

/// Scales to length 1 without overflow.
/// @throw Error(kUsage) if the vector has no direction
glm::dvec3 unitVector(const char* option, const glm::dvec3& v);

void refuseCamera(const char* option, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, option, got, expected);
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dvec3 unitVector(const char* option, const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!isFinite(v) || largest == 0) {
        refuseCamera(option, numberText(v), "three finite numbers, not all of them 0");
    }
    return glm::normalize(v / largest);
}

void checkNumber(const char* option, double number) {
    if (!std::isfinite(number)) refuseCamera(option, numberText(number), "a finite number");
}

void checkPositive(const char* option, const std::optional<double>& number) {
    if (number && !(std::isfinite(*number) && *number > 0))
        refuseCamera(option, numberText(*number), "a finite number > 0");
}

void checkSize(const CameraOptions& options) {
    const glm::ivec2 size = options.sizePixels;
    const std::string text = std::to_string(size.x) + "x" + std::to_string(size.y);
    if (size.x < 1 || size.y < 1) refuseCamera("`sizePixels`", text, "WxH, each at least 1");
    if (options.projection == Projection::kLatlong && size.x != 2 * std::int64_t{size.y})
        refuseCamera("`sizePixels`", text, "twice as wide as high for `projection` latlong");
}

// Refuses options that the projection does not have.
void checkProjection(const CameraOptions& options) {
    const auto requireFor = [&](bool given, bool allowed, const char* option,
                                const char* expected) {
        if (given && !allowed)
            refuseCamera(option, "`projection` " + projectionName(options.projection), expected);
    };
    const bool parallel = options.projection == Projection::kOrtho;
    const bool flat = options.projection == Projection::kPerspective;
    requireFor(options.frameWidthWorld.has_value(), parallel, "`frameWidthWorld`",
               "`projection` ortho, of which it is an option");
    requireFor(options.eyeWorld.has_value(), !parallel, "`eyeWorld`",
               "`projection` perspective or latlong");
    requireFor(options.nearWorld != 0, !parallel, "`nearWorld`",
               "`projection` perspective or latlong");
    requireFor(options.frameOffset != glm::dvec2(0), parallel || flat, "`frameOffset`",
               "`projection` ortho or perspective");
    requireFor(options.pixelAspect != 1, parallel || flat, "`pixelAspect`",
               "`projection` ortho or perspective");
    requireFor(options.distanceWorld.has_value(), parallel || flat, "`distanceWorld`",
               "`projection` ortho or perspective");
    for (const auto& [option, given] :
         {std::pair("`fovDegrees`", options.fovDegrees.has_value()),
          std::pair("`focalMm`", options.focalMm.has_value()),
          std::pair("`apertureMm`", options.apertureMm.has_value()),
          std::pair("`sourceToIsocenterWorld`", options.sourceToIsocenterWorld.has_value()),
          std::pair("`sourceToDetectorWorld`", options.sourceToDetectorWorld.has_value()),
          std::pair("`detectorWorld`", options.detectorWorld.has_value())})
        requireFor(given, flat, option, "`projection` perspective");
}

void checkLens(const CameraOptions& options) {
    if (options.fovDegrees && !(*options.fovDegrees > 0 && *options.fovDegrees < 180)) {
        refuseCamera("`fovDegrees`", numberText(*options.fovDegrees),
                     "a number of degrees greater than 0 and less than 180");
    }
    checkPositive("`focalMm`", options.focalMm);
    checkPositive("`apertureMm`", options.apertureMm);
    if (options.fovDegrees && (options.focalMm || options.apertureMm)) {
        refuseCamera("`fovDegrees`",
                     std::string("it and ") + (options.focalMm ? "`focalMm`" : "`apertureMm`"),
                     "the angle of view one way or the other");
    }
}

void checkEye(const CameraOptions& options) {
    if (options.projection != Projection::kOrtho) {
        checkPositive("`distanceWorld`", options.distanceWorld);
    } else if (options.distanceWorld) {
        checkNumber("`distanceWorld`", *options.distanceWorld);
    }
    const double nearest = options.nearWorld;
    if (!(std::isfinite(nearest) && nearest >= 0))
        refuseCamera("`nearWorld`", numberText(nearest), "a finite number of at least 0");
    if (!options.eyeWorld) return;
    const glm::dvec3 eye = *options.eyeWorld;
    if (!isFinite(eye)) refuseCamera("`eyeWorld`", numberText(eye), "three finite numbers");
    if (options.distanceWorld)
        refuseCamera("`distanceWorld`", "it and `eyeWorld`",
                     "the eye's place one way or the other");
    if (options.direction && options.targetWorld) {
        refuseCamera("`direction`", "it, `eyeWorld` and `targetWorld`",
                     "a line of sight one way or the other: without one of them");
    }
}

// Returns an option that also places or sizes a perspective camera.
const char* otherThanCArm(const CameraOptions& options) {
    if (options.fovDegrees) return "`fovDegrees`";
    if (options.focalMm) return "`focalMm`";
    if (options.apertureMm) return "`apertureMm`";
    if (options.eyeWorld) return "`eyeWorld`";
    return options.distanceWorld ? "`distanceWorld`" : nullptr;
}

void checkCArm(const CameraOptions& options) {
    const std::optional<double>& isocenter = options.sourceToIsocenterWorld;
    const std::optional<double>& detector = options.sourceToDetectorWorld;
    const std::optional<glm::dvec2>& size = options.detectorWorld;
    const int given = isocenter.has_value() + detector.has_value() + size.has_value();
    if (given == 0) return;
    if (given < 3) {
        refuseCamera(!isocenter  ? "`sourceToIsocenterWorld`"
                     : !detector ? "`sourceToDetectorWorld`"
                                 : "`detectorWorld`",
                     "none",
                     "`sourceToIsocenterWorld`, `sourceToDetectorWorld` and `detectorWorld`");
    }
    if (const char* other = otherThanCArm(options))
        refuseCamera(other, "it and `sourceToIsocenterWorld`", "the camera one way or the other");
    checkPositive("`sourceToIsocenterWorld`", isocenter);
    checkPositive("`sourceToDetectorWorld`", detector);
    if (*detector < *isocenter) {
        refuseCamera("`sourceToDetectorWorld`", numberText(*detector),
                     "at least `sourceToIsocenterWorld` " + numberText(*isocenter));
    }
    const std::string text = numberText(size->x) + "x" + numberText(size->y);
    if (!(std::isfinite(size->x + size->y) && size->x > 0 && size->y > 0))
        refuseCamera("`detectorWorld`", text, "WxH, two finite numbers > 0");
    const glm::ivec2 pixels = options.sizePixels;
    const double width = size->x / pixels.x;
    const double height = size->y / pixels.y * options.pixelAspect;
    if (!(std::abs(width - height) <= 1e-3 * width)) {
        refuseCamera(
            "`detectorWorld`",
            text + " of " + std::to_string(pixels.x) + "x" + std::to_string(pixels.y) + " pixels",
            "square pixels, as " + numberText(size->x) + "x" + numberText(width * pixels.y));
    }
}

void checkFrame(const CameraOptions& options) {
    const glm::dvec2& offset = options.frameOffset;
    if (!(std::abs(offset.x) <= kMostFrameOffset && std::abs(offset.y) <= kMostFrameOffset)) {
        refuseCamera("`frameOffset`", numberText(offset),
                     "two numbers from " + numberText(-kMostFrameOffset) + " to " +
                         numberText(kMostFrameOffset));
    }
    if (!(options.pixelAspect >= kLeastPixelAspect && options.pixelAspect <= kMostPixelAspect)) {
        refuseCamera("`pixelAspect`", numberText(options.pixelAspect),
                     "a number from " + numberText(kLeastPixelAspect) + " to " +
                         numberText(kMostPixelAspect));
    }
}

// A matrix excludes other options of placement.
void checkMatrix(const CameraOptions& options) {
    if (!options.worldFromCamera) return;
    const char* other = options.direction               ? "`direction`"
                        : options.targetWorld           ? "`targetWorld`"
                        : options.eyeWorld              ? "`eyeWorld`"
                        : options.distanceWorld         ? "`distanceWorld`"
                        : options.detectorWorld         ? "`detectorWorld`"
                        : options.azimuthDegrees != 0   ? "`azimuthDegrees`"
                        : options.elevationDegrees != 0 ? "`elevationDegrees`"
                        : options.rollDegrees != 0      ? "`rollDegrees`"
                                                        : nullptr;
    if (other) refuseCamera(other, "it and `worldFromCamera`", "the camera one way or the other");
}

void checkCameraOptions(const CameraOptions& options) {
    checkProjection(options);
    checkLens(options);
    checkEye(options);
    checkNumber("`azimuthDegrees`", options.azimuthDegrees);
    checkNumber("`elevationDegrees`", options.elevationDegrees);
    checkNumber("`rollDegrees`", options.rollDegrees);
    if (options.targetWorld && !isFinite(*options.targetWorld)) {
        refuseCamera("`targetWorld`", numberText(*options.targetWorld), "three finite numbers");
    }
    const double width = options.frameWidthWorld.value_or(1);
    if (!std::isfinite(width) || width <= 0) {
        refuseCamera("`frameWidthWorld`", numberText(width), "a number > 0");
    }
    checkSize(options);
    checkCArm(options);
    checkFrame(options);
    checkMatrix(options);
}

// Vectors in the space of a viewer of the front: x to the right, y up, z towards the eye.
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

const NamedView& namedView(const std::string& name) {
    std::string known;
    std::vector<std::string> names;
    for (const NamedView& view : kNamedViews) {
        if (name == view.name) return view;
        names.emplace_back(view.name);
        known += (known.empty() ? "" : ", ") + std::string(view.name);
    }
    refuseCamera("`view`", name, "one of " + known + afterStop(suggestion(name, names)));
}

// Orientation in the world of a viewer of the volume's front.
struct Viewer {
    glm::dmat3 worldFromViewer{1.0};
    bool facesPatient = false;

    // Adding 0 removes -0.
    glm::dvec3 toWorld(const glm::dvec3& v) const { return worldFromViewer * v + 0.0; }
};

Viewer viewerOf(const std::string& space) {
    // The patient's left is at the right, the head above, the front nearer.
    if (space == "RAS") return {glm::dmat3(-1, 0, 0, 0, 0, 1, 0, 1, 0), true};
    if (space == "LPS") return {glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0), true};
    return {};
}

// A facing patient's left is at the right.
std::string viewFrom(const Viewer& viewer, const std::string& view) {
    if (!viewer.facesPatient) return view;
    if (view == "left") return "right";
    return view == "right" ? "left" : view;
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

// The named line of sight, or that from an eye to the target. A panorama at its target needs none.
std::optional<glm::dvec3> givenDirection(const CameraOptions& options, const glm::dvec3& target) {
    if (options.direction || !options.eyeWorld) return options.direction;
    const glm::dvec3 direction = target - *options.eyeWorld;
    if (isFinite(direction) && direction != glm::dvec3(0)) return direction;
    if (options.projection == Projection::kLatlong && isFinite(direction)) return {};
    refuseCamera(
        "`eyeWorld`", numberText(*options.eyeWorld),
        "another place than the target " + numberText(target) + ", or a `direction` to look in");
}

bool areParallel(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(glm::cross(a, b)) < 1e-9;
}

// Returns the shortest turn between unit vectors, exact between axes. Opposite vectors turn by half
// about `halfTurn`, a unit vector across `from`.
glm::dmat3 turnBetween(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& halfTurn) {
    // Nearly opposite vectors start with half a turn, as the formula divides by rounding errors.
    constexpr double kOpposite = -1 + 1e-6;
    if (glm::dot(from, to) < kOpposite) {
        const glm::dmat3 half = 2.0 * glm::outerProduct(halfTurn, halfTurn) - glm::dmat3(1.0);
        return turnBetween(-from, to, halfTurn) * half;
    }
    const glm::dvec3 v = glm::cross(from, to);
    const glm::dmat3 cross(0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0);
    return glm::dmat3(1.0) + cross + cross * cross / (1 + glm::dot(from, to));
}

// Turns a viewer so that `up` is up.
Viewer standingIn(const Viewer& viewer, const glm::dvec3& up) {
    const NamedView& front = namedView("front");
    const glm::dvec3 seen = viewer.toWorld(front.direction);
    const glm::dmat3 turn = turnBetween(viewer.toWorld(front.up), unitVector("`up`", up), seen);
    return {turn * viewer.worldFromViewer, viewer.facesPatient};
}

// Returns the default up. For lines of sight straight up or down it is that of the named views.
glm::dvec3 defaultUp(const Viewer& viewer, const glm::dvec3& direction) {
    const glm::dvec3 up = viewer.toWorld(namedView("front").up);
    if (!areParallel(direction, up)) return up;
    return viewer.toWorld(namedView(glm::dot(direction, up) < 0 ? "top" : "bottom").up);
}

// Sets the axes of a camera that looks along `pointed`, or else as the view says; head to `up`.
void orient(Camera& camera, const CameraOptions& options, const Viewer& atFront,
            const std::optional<glm::dvec3>& pointed) {
    const NamedView& view = namedView(viewFrom(atFront, options.view));
    const Viewer viewer = options.up && !pointed ? standingIn(atFront, *options.up) : atFront;
    glm::dvec3 direction =
        unitVector("`direction`", pointed.value_or(viewer.toWorld(view.direction)));
    const glm::dvec3 up =
        unitVector("`up`", pointed ? options.up.value_or(defaultUp(viewer, direction))
                                   : viewer.toWorld(view.up));
    if (areParallel(direction, up)) {
        refuseCamera(
            "`up`",
            numberText(*options.up) + ", parallel to the line of sight " + numberText(direction),
            "a direction that differs from it");
    }

    // Azimuth turns about the given up, the other angles about the camera's own axes.
    direction = turned(direction, up, options.azimuthDegrees);
    camera.right = glm::normalize(glm::cross(direction, up));
    camera.direction = turned(direction, camera.right, -options.elevationDegrees);
    camera.right = turned(camera.right, camera.direction, options.rollDegrees);
    camera.up = glm::cross(camera.right, camera.direction);
}

glm::dvec3 transformed(const glm::dmat4& worldFromIndex, const glm::dvec3& index) {
    return glm::dvec3(worldFromIndex * glm::dvec4(index, 1));
}

// Returns the narrowest frame that holds the projected box in both directions.
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

    // A point, or a line seen end-on, is framed as one voxel. Rounding may make it more than zero.
    const double aspect = double(camera.sizePixels.x) / camera.sizePixels.y * camera.pixelAspect;
    const double width = std::max(extent.x, extent.y * aspect);
    return width > 1e-6 * voxel ? width : voxel;
}

// Returns the distance before the target at which all voxels, with footprints, lie ahead.
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

// Returns half the picture's width at distance 1.
double tangentOf(const CameraOptions& options) {
    constexpr double kRadians = std::numbers::pi / 180;
    if (options.detectorWorld)
        return 0.5 * options.detectorWorld->x / *options.sourceToDetectorWorld;
    if (options.focalMm || options.apertureMm) {
        return 0.5 * options.apertureMm.value_or(kDefaultApertureMm) /
               options.focalMm.value_or(kDefaultFocalMm);
    }
    const double half = 0.5 * kRadians * options.fovDegrees.value_or(kDefaultFov);
    const double tangent = portable::sin(half) / portable::cos(half);
    return tangent * options.sizePixels.x / options.sizePixels.y * options.pixelAspect;
}

// Returns the least distance from eye to target with the whole box in the picture. A point, or a
// line seen end-on, is framed as one voxel.
double fittingDistance(const Camera& camera, double tangent, const IndexBox& box,
                       const glm::dmat4& worldFromIndex) {
    const double aspect = double(camera.sizePixels.x) / camera.sizePixels.y * camera.pixelAspect;
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index = cornerOf(box, corner);
        const glm::dvec3 offset = transformed(worldFromIndex, index) - camera.targetWorld;
        const double across = std::max(std::abs(glm::dot(offset, camera.right)),
                                       std::abs(glm::dot(offset, camera.up)) * aspect);
        distance = std::max(distance, across / tangent - glm::dot(offset, camera.direction));
    }
    const glm::dmat3 linear(worldFromIndex);
    const double voxel =
        std::min({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    return std::max(distance, 0.5 * voxel / tangent);
}

void placeEye(Camera& camera, const CameraOptions& options, const glm::dvec3& target,
              const IndexBox& box, const glm::dmat4& worldFromIndex) {
    const bool panorama = options.projection == Projection::kLatlong;
    const double tangent = panorama ? std::numbers::pi : tangentOf(options);
    double distance = 0;
    if (options.eyeWorld && options.direction) {
        // The target is as far away as the volume's middle, but not behind the eye.
        distance = std::max(glm::dot(target - *options.eyeWorld, camera.direction),
                            glm::length(glm::dvec3(worldFromIndex[0])));
        camera.targetWorld = *options.eyeWorld + distance * camera.direction;
    } else if (options.eyeWorld && target != *options.eyeWorld) {
        // Turning about the eye moves the target.
        distance = glm::distance(target, *options.eyeWorld);
        camera.targetWorld = *options.eyeWorld + distance * camera.direction;
    } else if (panorama) {
        // The eye is at the target and cannot look at it.
        distance = glm::length(glm::dvec3(worldFromIndex[0]));
        camera.targetWorld = target + distance * camera.direction;
    } else {
        const std::optional<double>& given =
            options.detectorWorld ? options.sourceToIsocenterWorld : options.distanceWorld;
        distance = given ? *given : fittingDistance(camera, tangent, box, worldFromIndex);
    }
    camera.targetDistanceWorld = distance;
    camera.frameWidthWorld = 2 * distance * tangent;
    if (!std::isfinite(camera.frameWidthWorld) || camera.frameWidthWorld <= 0 ||
        !isFinite(camera.targetWorld)) {
        refuseCamera(options.eyeWorld ? "`eyeWorld`" : "`distanceWorld`",
                     numberText(distance) + " to the target", "a distance that numbers can hold");
    }
}

// Places a camera by a matrix. The target is as far away as the volume's middle, but not behind.
void placeByMatrix(Camera& camera, CameraOptions options, const IndexBox& box,
                   const glm::dmat4& worldFromIndex) {
    const CameraAxes axes =
        cameraAxes(*options.worldFromCamera, "`worldFromCamera`", ErrorCode::kUsage);
    camera.right = axes.right;
    camera.up = axes.up;
    camera.direction = axes.direction;
    if (options.projection != Projection::kOrtho) {
        options.eyeWorld = axes.positionWorld;
        options.direction = axes.direction;
        return placeEye(camera, options, camera.targetWorld, box, worldFromIndex);
    }
    camera.targetDistanceWorld =
        std::max(glm::dot(camera.targetWorld - axes.positionWorld, axes.direction),
                 glm::length(glm::dvec3(worldFromIndex[0])));
    camera.targetWorld = axes.positionWorld + camera.targetDistanceWorld * axes.direction;
    camera.frameWidthWorld =
        options.frameWidthWorld.value_or(fittingFrame(camera, box, worldFromIndex));
}

}  // namespace

Camera makeCamera(const CameraOptions& options, const IndexBox& box,
                  const glm::dmat4& worldFromIndex, const std::string& space) {
    const DefaultFloats floats;
    checkCameraOptions(options);
    requireInvertible(worldFromIndex);
    const IndexBox framed = box.empty() ? IndexBox{glm::ivec3(0), glm::ivec3(0)} : box;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(framed.min) + glm::dvec3(framed.max));

    Camera camera;
    camera.projection = options.projection;
    camera.sizePixels = options.sizePixels;
    camera.nearWorld = options.nearWorld;
    camera.pixelAspect = options.pixelAspect;
    camera.targetInFrame = {0.5 - options.frameOffset.x, 0.5 + options.frameOffset.y};
    camera.targetWorld = options.targetWorld.value_or(transformed(worldFromIndex, middle));
    if (options.worldFromCamera) {
        placeByMatrix(camera, options, framed, worldFromIndex);
        return camera.withOverscan(options.overscanPixels);
    }
    orient(camera, options, viewerOf(space), givenDirection(options, camera.targetWorld));
    if (options.projection != Projection::kOrtho) {
        placeEye(camera, options, camera.targetWorld, framed, worldFromIndex);
        return camera.withOverscan(options.overscanPixels);
    }
    camera.frameWidthWorld =
        options.frameWidthWorld.value_or(fittingFrame(camera, framed, worldFromIndex));
    camera.targetDistanceWorld =
        options.distanceWorld.value_or(clearDistance(camera, framed, worldFromIndex));
    return camera.withOverscan(options.overscanPixels);
}

}  // namespace deltasplat
