// SPDX-License-Identifier: Apache-2.0
#include "optics/color_factor.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

namespace deltasplat {

glm::dvec3 ColorFactor::largestOf(const ColorGrids& grids) {
    glm::dvec3 largest(1);
    for (int c = 0; c < 3; ++c)
        largest[c] = std::clamp(grids[std::size_t(c)]->valueMax, 1.0, kBrightestColor);
    return largest;
}

std::uint32_t ColorFactor::packed(const glm::dvec3& share) {
    const glm::dvec3 root = glm::sqrt(glm::clamp(share, 0.0, 1.0));
    const auto bits = [](double part, int most) { return std::uint32_t(part * most + 0.5); };
    return bits(root.x, 2047) | bits(root.y, 2047) << 11 | bits(root.z, 1023) << 22;
}

glm::vec3 ColorFactor::unpacked(std::uint32_t bits) {
    const glm::vec3 root(float(bits & 2047) / 2047, float(bits >> 11 & 2047) / 2047,
                         float(bits >> 22) / 1023);
    return root * root;
}

WordFactors factorsOf(const OwnLook* looks) {
    WordFactors factors;
    for (std::size_t n = 0; n < 64; ++n) {
        const glm::vec3 factor = ColorFactor::unpacked(factorBits(looks[n]));
        for (int c = 0; c < 3; ++c) factors[std::size_t(c)][n] = factor[c];
    }
    return factors;
}

}  // namespace deltasplat
