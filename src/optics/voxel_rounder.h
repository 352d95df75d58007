// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/color_digits.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// Writes colours that voxels have of their own in digits, as ClassTable says.
class VoxelRounder {
  public:
    /// @param classes    of opacities
    /// @param brightest  as VoxelPainter::brightest
    VoxelRounder(const ClassTable& classes, const glm::dvec3& brightest);

    /// Value of one unit of each channel on the first plane; 0 for one that is always 0.
    const glm::dvec4& scale() const { return scale_; }
    /// Returns the premultiplied colour of a voxel that is seen.
    ColorDigits operator()(const VoxelLook& look) const;

  private:
    std::vector<double> alphas_;  // [classes]: as shares of the largest
    glm::dvec3 brightest_;
    glm::dvec4 scale_;
};

}  // namespace deltasplat
