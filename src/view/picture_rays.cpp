// SPDX-License-Identifier: Apache-2.0
#include "view/picture_rays.h"

#include <numbers>

#include "portable_math.h"

namespace deltasplat {

PictureRays::PictureRays(const Camera& camera, const glm::dmat3& fromWorld) {
    const glm::dvec3 right = fromWorld * camera.right;
    const glm::dvec3 up = fromWorld * camera.up;
    const glm::dvec3 ahead = fromWorld * camera.direction;
    const glm::dvec2 size(camera.sizePixels);
    const bool flat = camera.projection == Projection::kPerspective;
    // Of a flat picture at distance 1.
    const double pixel = camera.pixelWorld() / camera.targetDistanceWorld;
    for (int x = 0; x < camera.sizePixels.x; ++x) {
        const double across = x + 0.5 - 0.5 * size.x;
        const double longitude = 2 * std::numbers::pi * across / size.x;
        columns_.push_back(flat ? ahead + (across * pixel) * right
                                : portable::sin(longitude) * right +
                                      portable::cos(longitude) * ahead);
    }
    for (int y = 0; y < camera.sizePixels.y; ++y) {
        const double above = 0.5 * size.y - (y + 0.5);
        const double latitude = std::numbers::pi * above / size.y;
        if (flat) {
            rows_.push_back({1, (above * pixel) * up});
        } else {
            rows_.push_back({portable::cos(latitude), portable::sin(latitude) * up});
        }
    }
}

}  // namespace deltasplat
