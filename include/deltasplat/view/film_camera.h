// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// How a film back of another shape than the picture's fits.
enum class FilmFit {
    kHorizontal,  ///< the picture is as wide as the film back
    kVertical,    ///< as high
    kFill,        ///< the largest picture within the film back
    kOverscan,    ///< the smallest picture around it
    kStretch      ///< all of it and no more: pixels are not square
};

/// Returns "horizontal", "vertical", "fill", "overscan" or "stretch".
std::string filmFitName(FilmFit fit);

/// A camera as in animation programs: a film back behind a lens in the world.
struct FilmCamera {
    Projection projection = Projection::kPerspective;
    /// As CameraOptions::worldFromCamera, but a scale counts: it scales the camera's own lengths,
    /// `frameWidthWorld`, `nearWorld` and `farWorld`.
    glm::dmat4 worldFromCamera{1.0};
    double focalMm = kDefaultFocalMm;  ///< > 0; kPerspective only
    /// Size of the film back, > 0; a height of 0 is the picture's.
    glm::dvec2 apertureMm{kDefaultApertureMm, 0};
    /// Shift of the film picture's middle to the right of and above the line of sight. (Film backs
    /// see things upside down: the film itself is shifted the other way.)
    glm::dvec2 offsetMm{0.0};
    FilmFit fit = FilmFit::kHorizontal;    ///< where `apertureMm` has a height
    double pixelAspect = 1;                ///< width over height; kStretch: has no effect
    double frameWidthWorld = 1;            ///< kOrtho: width of the film back in the world, > 0
    double nearWorld = 0;                  ///< >= 0; kOrtho: nearer voxels are visible too
    std::optional<double> farWorld;        ///< for information; cuts nothing off
    std::optional<glm::ivec2> sizePixels;  ///< of the picture it was made for
};

/// @param sizePixels  of the picture to be made, each at least 1
/// @throw Error(kUsage) naming the field, if a number is not finite or out of range or the matrix
///        does more than turn, evenly scale and move
CameraOptions cameraOptions(const FilmCamera& camera, glm::ivec2 sizePixels);

}  // namespace deltasplat
