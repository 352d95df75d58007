// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/view/camera.h"

namespace deltasplat::test {

/// A line of sight in the world.
struct SightLine {
    glm::dvec3 start;
    glm::dvec3 ray;  ///< of length 1
};

/// Returns the one of a place in a picture: from the eye, or, in parallel, from far enough before
/// what is seen.
/// @param pixel   in pixels from the upper left corner
/// @param before  world units before the camera's plane
inline SightLine sightLineOf(const Camera& camera, const glm::dvec2& pixel, double before) {
    if (camera.projection == Projection::kOrtho)
        return {camera.worldFromPixel(pixel) - before * camera.direction, camera.direction};
    return {camera.eyeWorld(), glm::normalize(camera.rayThrough(pixel))};
}

}  // namespace deltasplat::test
