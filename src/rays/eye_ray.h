// SPDX-License-Identifier: Apache-2.0
// Based on: Peter M. Joseph, "An Improved Algorithm for Reprojecting Rays through Pixel Images",
// 1982: a ray reads each slice of the axis that it is most parallel to once, between the four
// voxels that it goes through. What the eye or the near plane cuts of a slice is our own.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "rays/ray_bricks.h"

namespace deltasplat {

/// A line of sight from an eye, in (slice, u, v) order of the axis that it is most parallel to, of
/// several the last. Positions are those of RayBricks.
struct EyeRay {
    glm::ivec3 order{0, 1, 2};
    bool goesUp = true;  ///< towards slices of larger numbers
    glm::dvec3 eye{0.0};
    glm::dvec2 slope{0.0};  ///< voxels along u and v for each slice
    double nearest = 0;     ///< slices from the eye to what is seen first, >= 0
    glm::ivec2 slices{0};   ///< first and last that it may meet, as it goes; none before clip()

    /// @param eye  in positions
    /// @param ray  of any length, in voxels
    EyeRay(const glm::dvec3& eyePosition, const glm::dvec3& ray);

    /// Finds the slices that it meets.
    /// @param nearestSlices  as `nearest`
    /// @param box            of voxels, in positions, in x, y, z order
    void clip(double nearestSlices, const IndexBox& box);
};

/// What a ray reads of a slice, between four voxels.
struct SliceTaps {
    BrickTaps voxels;
    float u, v;       ///< way from the first to the next, 0 <= u, v < 1
    double share;     ///< of the way through the slice, what is seen
    double distance;  ///< slices from the eye

    float read() const {
        const float here = voxels.first + u * (voxels.nextU - voxels.first);
        const float there = voxels.nextV + u * (voxels.nextBoth - voxels.nextV);
        return here + v * (there - here);
    }
};

/// Calls take(taps) for the slices that a ray meets, from the eye on, but for those of which all
/// voxels around are in empty bricks.
/// @param box  as of EyeRay::clip
template <class Take>
void followEyeRay(const RayBricks& bricks, const EyeRay& ray, const IndexBox& box,
                  const Take& take) {
    const BrickReader reader(bricks, ray.order);
    const glm::dvec2 low = glm::dvec2(box.min[ray.order[1]], box.min[ray.order[2]]) - 1.0;
    const glm::dvec2 high = glm::dvec2(box.max[ray.order[1]], box.max[ray.order[2]]) + 1.0;
    const int step = ray.goesUp ? 1 : -1;
    SliceTaps taps;
    for (int slice = ray.slices.x; (ray.slices.y - slice) * step >= 0; slice += step) {
        taps.distance = step * (slice - ray.eye.x);
        taps.share = 1;
        // Of what is cut, the middle of what is left stands for it.
        if (taps.distance - 0.5 < ray.nearest) {
            taps.share = taps.distance + 0.5 - ray.nearest;
            if (!(taps.share > 0)) continue;
            taps.distance = ray.nearest + 0.5 * taps.share;
        }
        const double u = ray.eye.y + ray.slope.x * taps.distance;
        const double v = ray.eye.z + ray.slope.y * taps.distance;
        if (!(u > low.x && u < high.x && v > low.y && v < high.y)) continue;
        const int firstU = int(u);
        const int firstV = int(v);
        taps.u = float(u - firstU);
        taps.v = float(v - firstV);
        if (reader.read(slice, firstU, firstV, taps.voxels)) take(taps);
    }
}

}  // namespace deltasplat
