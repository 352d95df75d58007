// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>

#include "deltasplat/view/camera.h"
#include "view/picture_rays.h"

namespace deltasplat {

/// How deep a line of sight, which crosses all slices, lies at a position along the slice axis.
struct DepthLine {
    double first = 0;  ///< at position 0
    double perSlice = 0;

    double at(double slice) const { return first + perSlice * slice; }
};

/// How deep slices lie in a picture, pixel by pixel: along the camera's line of sight as OpenEXR's
/// worldToCamera has it, of kLatlong along each pixel's, in world units.
class SliceDepths {
  public:
    /// @param worldFromSlices  from (slice, u, v), counted from anywhere
    SliceDepths(const Camera& camera, const glm::dmat4& worldFromSlices);

    /// Of the middle of a pixel.
    DepthLine lineAt(int x, int y) const;
    /// What is nearer is not seen.
    double nearest() const { return camera_.nearWorld; }

  private:
    Camera camera_;
    glm::dvec3 origin_;  // in the world, position 0 along the axis
    glm::dvec3 slicesPerWorld_;
    std::optional<PictureRays> rays_;  // from an eye
};

}  // namespace deltasplat
