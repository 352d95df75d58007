// SPDX-License-Identifier: Apache-2.0
#include "optics/voxel_rounder.h"

#include <algorithm>

namespace deltasplat {

VoxelRounder::VoxelRounder(const ClassTable& classes, const glm::dvec3& brightest)
    : alphas_(classes.alphas()), brightest_(brightest) {
    const double largest = *std::max_element(alphas_.begin(), alphas_.end());
    scale_ = glm::dvec4(brightest, 1) * largest / double(ClassTable::kMax);
    // As shares they can be neither too large nor too small to reckon with.
    for (double& alpha : alphas_) alpha = largest > 0 ? alpha / largest : 0;
}

ColorDigits VoxelRounder::operator()(const VoxelLook& look) const {
    constexpr auto kMost = double(ClassTable::kMax);
    const double alpha = alphas_[look.number];
    const glm::dvec3 color = look.color.color();
    glm::dvec4 units(0, 0, 0, alpha * kMost);
    for (int c = 0; c < 3; ++c) {
        const double share = brightest_[c] > 0 && scale_[c] > 0 ? color[c] / brightest_[c] : 0;
        units[c] = std::min(share, 1.0) * alpha * kMost;
    }
    return digitsOf(units);
}

}  // namespace deltasplat
