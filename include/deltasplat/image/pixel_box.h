// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace deltasplat {

/// Pixels [min, max) of a picture, counted from the top left one.
struct PixelBox {
    glm::ivec2 min{0};
    glm::ivec2 max{0};

    glm::ivec2 size() const { return max - min; }
    bool empty() const { return max.x <= min.x || max.y <= min.y; }
    bool operator==(const PixelBox&) const = default;
};

}  // namespace deltasplat
