// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {
namespace {

// The same camera with so many pixels more, or less, at each side.
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
