// SPDX-License-Identifier: Apache-2.0
#include "optics/voxel_rounder.h"

#include <algorithm>

namespace deltasplat {

VoxelRounder::VoxelRounder(const ClassTable& classes, const glm::dvec3& brightest)
    : alphas_(classes.alphas()) {
    const double largest = *std::max_element(alphas_.begin(), alphas_.end());
    scale_ = glm::dvec4(brightest, 1) * largest / double(ClassTable::kMax);
    for (int c = 0; c < 4; ++c) unitsOfOne_[c] = scale_[c] > 0 ? 1 / scale_[c] : 0;
}

ColorDigits VoxelRounder::operator()(const VoxelLook& look) const {
    const double alpha = alphas_[look.number];
    glm::dvec4 units = glm::dvec4(look.color.color(), 1) * alpha * unitsOfOne_;
    for (int c = 0; c < 4; ++c) units[c] = std::min(units[c], double(ClassTable::kMax));
    return digitsOf(units);
}

}  // namespace deltasplat
