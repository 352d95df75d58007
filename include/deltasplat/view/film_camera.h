// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// What becomes of a film back whose shape is not the picture's.
enum class FilmFit {
    kHorizontal,  ///< the picture is as wide as the film back
    kVertical,    ///< as high
    kFill,        ///< the largest that lies within the film back
    kOverscan,    ///< the smallest that holds it
    kStretch      ///< all of it and no more: pixels are not square
};

/// Returns "horizontal", "vertical", "fill", "overscan" or "stretch".
std::string filmFitName(FilmFit fit);

/// A camera as programs for animation have it: a film back behind a lens, somewhere in the world.
struct FilmCamera {
    Projection projection = Projection::kPerspective;
    /// As CameraOptions::worldFromCamera, but its scale, if it has one, counts: it scales the
    /// camera's own lengths, `frameWidthWorld`, `nearWorld` and `farWorld`.
    glm::dmat4 worldFromCamera{1.0};
    double focalMm = kDefaultFocalMm;  ///< > 0; kPerspective only
    /// Width and height of the film back, > 0; a height of 0 is that of the picture.
    glm::dvec2 apertureMm{kDefaultApertureMm, 0};
    /// By how much the middle of the film's picture lies to the right of and above the line of
    /// sight. (Film backs see things upside down: the film itself lies on the other side.)
    glm::dvec2 offsetMm{0.0};
    FilmFit fit = FilmFit::kHorizontal;    ///< where `apertureMm` has a height
    double pixelAspect = 1;                ///< width over height; kStretch: has no effect
    double frameWidthWorld = 1;            ///< kOrtho: of the film back's width in the world, > 0
    double nearWorld = 0;                  ///< >= 0; kOrtho: what is nearer is seen all the same
    std::optional<double> farWorld;        ///< nothing is cut off there: for who wants to say so
    std::optional<glm::ivec2> sizePixels;  ///< of the picture that it was made for
};

/// Returns what makes the same picture of a volume.
/// @param sizePixels  of the picture to be made, each at least 1
/// @throw Error(kUsage) naming the field, if a number is not finite or out of range or the matrix
///        is more than turned, evenly scaled and moved
CameraOptions cameraOptions(const FilmCamera& camera, glm::ivec2 sizePixels);

}  // namespace deltasplat
