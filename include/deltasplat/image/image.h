// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

namespace deltasplat {

/// A picture of float RGBA, scene-linear and premultiplied: `[height][width][4]`, from the top.
struct Image {
    glm::ivec2 size{0};
    std::vector<float> rgba;

    Image() = default;
    explicit Image(glm::ivec2 sizePixels)
        : size(sizePixels), rgba(std::size_t{4} * sizePixels.x * sizePixels.y) {}
    float* pixel(int x, int y) { return &rgba[4 * (std::size_t(y) * size.x + x)]; }
    const float* pixel(int x, int y) const { return &rgba[4 * (std::size_t(y) * size.x + x)]; }
};

/// Depth of an empty pixel, as in Cycles.
inline constexpr float kNoDepth = 1e10f;

}  // namespace deltasplat
