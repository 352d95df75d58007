// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "view/base_plane.h"

namespace deltasplat {

/// One float for each pixel of a part of the base plane: `[row][width]`.
struct RayPlane {
    PlaneBox box;
    std::vector<float> values;

    explicit RayPlane(const PlaneBox& planeBox, float value = 0)
        : box(planeBox), values(std::size_t(planeBox.size().x) * planeBox.size().y, value) {}

    /// @param y  a row of the base plane
    float* row(int y) { return &values[std::size_t(y - box.min.y) * box.size().x]; }
    const float* row(int y) const { return const_cast<RayPlane*>(this)->row(y); }
};

/// What following the lines of sight gives for each pixel.
struct RayPlanes {
    RayPlane values;
    std::optional<RayPlane> places;  ///< the slice, counted from the first, that a value is from
};

}  // namespace deltasplat
