// SPDX-License-Identifier: Apache-2.0
#include "view/picture_rays.h"

#include <numbers>

#include "base/portable_math.h"

namespace deltasplat {

PictureRays::PictureRays(const Camera& camera, const glm::dmat3& fromWorld) {
    const glm::dvec3 right = fromWorld * camera.right;
    const glm::dvec3 up = fromWorld * camera.up;
    const glm::dvec3 ahead = fromWorld * camera.direction;
    const glm::dvec2 size(camera.sizePixels);
    const bool flat = camera.projection == Projection::kPerspective;
    const glm::dvec2 middle = camera.targetPixel();
    // Of a flat picture at distance 1.
    const double pixel = camera.pixelWorld() / camera.targetDistanceWorld;
    const double pixelHeight = camera.pixelHeightWorld() / camera.targetDistanceWorld;
    // Of a panorama: the angle of a pixel.
    const glm::dvec2 angle = glm::dvec2(2, 1) * std::numbers::pi / size;
    for (int x = 0; x < camera.sizePixels.x; ++x) {
        const double across = x + 0.5 - middle.x;
        if (flat) {
            columns_.push_back({ahead + (across * pixel) * right, pixel * right});
            continue;
        }
        const double sine = portable::sin(angle.x * across);
        const double cosine = portable::cos(angle.x * across);
        columns_.push_back(
            {sine * right + cosine * ahead, angle.x * (cosine * right - sine * ahead)});
    }
    for (int y = 0; y < camera.sizePixels.y; ++y) {
        const double above = middle.y - (y + 0.5);
        if (flat) {
            rows_.push_back({1, 0, (above * pixelHeight) * up, -pixelHeight * up});
            continue;
        }
        const double sine = portable::sin(angle.y * above);
        const double cosine = portable::cos(angle.y * above);
        rows_.push_back({cosine, angle.y * sine, sine * up, -angle.y * cosine * up});
    }
}

}  // namespace deltasplat
