// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// A volume's axes in the order and the directions of a line of sight: (slice, u, v), of which the
/// first is the one that it is most parallel to, of several the last. It goes to larger positions
/// along each.
struct RayAxes {
    glm::ivec3 order{0, 1, 2};
    glm::ivec3 sign{1};   ///< 1 or -1: the way along order[i]
    glm::ivec3 first{0};  ///< voxel of position 0
    glm::ivec3 count{0};  ///< positions of the volume's box

    int voxelAt(int i, int position) const { return first[i] + sign[i] * position; }
    bool operator==(const RayAxes&) const = default;
};

/// A line of sight in positions of its axes: at slice s it meets (u, v) = start + s * slope.
struct SightRay {
    RayAxes axes;
    glm::dvec2 start{0.0};
    glm::dvec2 slope{0.0};     ///< 0 to 1
    double nearest = 0;        ///< the slice, or the place between two, at which it begins
    glm::dvec2 slices{0, -1};  ///< between which it may meet anything; none if the second is less

    /// @param box      of voxels
    /// @param through  a point that it goes through, in voxels from the box's first, so that
    ///                 numbers stay small
    /// @param ray      of any length, in voxels
    SightRay(const IndexBox& box, const glm::dvec3& through, const glm::dvec3& ray);

    /// Moves it to another point, without changing its direction.
    void moveTo(const glm::dvec3& through);
    /// Makes it begin at so many slices from the point that it was made with.
    void beginAt(double slicesFromPoint);
    double slicesFromPoint(double slice) const { return slice - point_; }

  private:
    void clip();
    double point_;  // slice of the point that it goes through
};

}  // namespace deltasplat
