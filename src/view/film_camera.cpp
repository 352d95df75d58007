// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/view/film_camera.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/view/camera.h"
#include "view/camera_axes.h"

namespace deltasplat {

namespace {

[[noreturn]] void refuse(const char* field, double got, const char* expected) {
    throw Error(ErrorCode::kUsage, field, numberText(got), expected);
}

void checkPositive(const char* field, double number) {
    if (!(std::isfinite(number) && number > 0)) refuse(field, number, "a finite number > 0");
}

void checkAtLeast0(const char* field, double number) {
    if (!(std::isfinite(number) && number >= 0)) refuse(field, number, "a finite number >= 0");
}

void checkNumbers(const FilmCamera& camera) {
    checkPositive("film: focalMm", camera.focalMm);
    checkPositive("film: apertureMm", camera.apertureMm.x);
    checkAtLeast0("film: apertureMm", camera.apertureMm.y);
    for (const double offset : {camera.offsetMm.x, camera.offsetMm.y})
        if (!std::isfinite(offset)) refuse("film: offsetMm", offset, "a finite number");
    checkPositive("film: pixelAspect", camera.pixelAspect);
    checkPositive("film: frameWidthWorld", camera.frameWidthWorld);
    checkAtLeast0("film: nearWorld", camera.nearWorld);
}

// The visible part of the film's plane, and its pixels.
struct Gate {
    glm::dvec2 sizeMm;
    double pixelAspect;
};

// Returns the width in mm of a picture with this aspect.
double widthOf(const FilmCamera& camera, double aspect) {
    const glm::dvec2 film = camera.apertureMm;
    if (film.y == 0) return film.x;
    switch (camera.fit) {
        case FilmFit::kVertical:
            return film.y * aspect;
        case FilmFit::kFill:
            return std::min(film.x, film.y * aspect);
        case FilmFit::kOverscan:
            return std::max(film.x, film.y * aspect);
        case FilmFit::kHorizontal:
        case FilmFit::kStretch:
            break;
    }
    return film.x;
}

Gate gateOf(const FilmCamera& camera, glm::ivec2 sizePixels) {
    const double pixels = double(sizePixels.x) / sizePixels.y;
    const glm::dvec2 film = camera.apertureMm;
    if (camera.fit == FilmFit::kStretch && film.y > 0) return {film, film.x / film.y / pixels};
    const double aspect = pixels * camera.pixelAspect;
    const double width = widthOf(camera, aspect);
    return {{width, width / aspect}, camera.pixelAspect};
}

}  // namespace

std::string filmFitName(FilmFit fit) {
    return enumName(fit, {"horizontal", "vertical", "fill", "overscan", "stretch"});
}

CameraOptions cameraOptions(const FilmCamera& camera, glm::ivec2 sizePixels) {
    const DefaultFloats floats;
    checkNumbers(camera);
    const CameraAxes axes =
        cameraAxes(camera.worldFromCamera, "film: worldFromCamera", ErrorCode::kUsage);
    const Gate gate = gateOf(camera, sizePixels);
    CameraOptions options;
    options.projection = camera.projection;
    options.worldFromCamera = camera.worldFromCamera;
    options.sizePixels = sizePixels;
    if (camera.projection == Projection::kLatlong) {
        options.nearWorld = axes.scale * camera.nearWorld;
        return options;
    }
    options.frameOffset = camera.offsetMm / gate.sizeMm;
    options.pixelAspect = gate.pixelAspect;
    if (camera.projection == Projection::kOrtho) {
        options.frameWidthWorld =
            axes.scale * camera.frameWidthWorld * (gate.sizeMm.x / camera.apertureMm.x);
        return options;
    }
    options.focalMm = camera.focalMm;
    options.apertureMm = gate.sizeMm.x;
    options.nearWorld = axes.scale * camera.nearWorld;
    return options;
}

namespace {

Camera grown(const Camera& camera, glm::ivec2 pixels) {
    Camera other = camera;
    other.overscanPixels += pixels;
    other.sizePixels += 2 * pixels;
    other.frameWidthWorld = camera.pixelWorld() * other.sizePixels.x;
    other.targetInFrame =
        (camera.targetPixel() + glm::dvec2(pixels)) / glm::dvec2(other.sizePixels);
    return other;
}

}  // namespace

Camera Camera::withOverscan(glm::ivec2 pixels) const {
    const auto isFine = [](int count) { return count >= 0 && count <= kMostOverscan; };
    const std::string text = std::to_string(pixels.x) + "," + std::to_string(pixels.y);
    if (!isFine(pixels.x) || !isFine(pixels.y)) {
        throw Error(ErrorCode::kUsage, "`overscanPixels`", text,
                    "two numbers within 0.." + std::to_string(kMostOverscan));
    }
    if (pixels != glm::ivec2(0) && projection == Projection::kLatlong) {
        throw Error(ErrorCode::kUsage, "`overscanPixels`", "`projection` latlong",
                    "`projection` ortho or perspective");
    }
    return pixels == glm::ivec2(0) ? *this : grown(*this, pixels);
}

Camera Camera::withoutOverscan() const {
    return overscanPixels == glm::ivec2(0) ? *this : grown(*this, -overscanPixels);
}

}  // namespace deltasplat
