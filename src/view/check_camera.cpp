// SPDX-License-Identifier: Apache-2.0
#include "view/check_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

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

namespace {

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

// What one projection has and another has not must not be asked for.
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

// What else says where a perspective camera is and how much it sees.
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

// A matrix says all of where the camera is.
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

}  // namespace

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

}  // namespace deltasplat
