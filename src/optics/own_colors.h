// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <glm/vec3.hpp>

#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns the look that is a colour, scene-linear and not multiplied by opacity: three half
/// floats of at least 0, which have one notation each.
inline OwnLook lookOfColor(const glm::dvec3& color) {
    OwnLook look;
    for (int c = 0; c < 3; ++c)
        look.bits[std::size_t(c)] = openvdb::math::half(float(color[c])).bits();
    return look;
}

/// Returns the colour that lookOfColor() made a look of.
inline glm::dvec3 colorOfLook(const OwnLook& look) {
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) {
        openvdb::math::half half;
        half.setBits(look.bits[std::size_t(c)]);
        color[c] = float(half);
    }
    return color;
}

}  // namespace deltasplat
