// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "reference/reference_renderer.h"

// A plain renderer in double precision that steps along each pixel's line of sight and reads values
// trilinearly: no slices, no base plane, no warp, nothing of the library's code.
namespace reference {

/// What is marched through.
struct Medium {
    /// Value at a voxel; 0 outside.
    std::function<double(int x, int y, int z)> valueAt;
    std::array<Vector, 3> axes;  ///< world vectors of one voxel along x, y and z
    Vector origin{};             ///< world position of voxel (0, 0, 0)
    std::array<int, 3> first{};  ///< index of the first voxel
    std::array<int, 3> last{};   ///< and of the last
    /// Colour and opacity over one unit of world length, of a value.
    std::function<std::array<double, 4>(double value)> look;
};

/// Lines of sight: from where, and which way, through pixel coordinates with middles at halves.
struct Eye {
    std::function<Vector(double x, double y)> from;
    std::function<Vector(double x, double y)> towards;  ///< of any length
    int width = 64;
    int height = 64;
    int samples = 1;  ///< along each side of a pixel, of which the mean is taken
};

/// Returns the picture, steps of `step` world units.
Picture march(const Medium& medium, const Eye& eye, double step);

}  // namespace reference
