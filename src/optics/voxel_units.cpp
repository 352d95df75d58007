// SPDX-License-Identifier: Apache-2.0
#include "optics/voxel_units.h"

#include <algorithm>
#include <glm/common.hpp>

#include "base/portable_math.h"

namespace deltasplat {
namespace {

// Cap of shares_: dimming by more than this is black anyway.
constexpr float kMostShare = 1e36f;

}  // namespace

VoxelUnits::VoxelUnits(const ClassTable& classes, const glm::dvec3& brightest)
    : unitDistances_(
          float(classes.stepWorld / classes.unitDistanceWorld * classes.extinctionScale)),
      brightest_(brightest) {
    const std::vector<double> alphas = classes.alphas();
    const double largest = *std::max_element(alphas.begin(), alphas.end());
    scale_ = glm::dvec4(brightest, 1) * largest / double(ClassTable::kMax);
    // Shares of the largest neither overflow nor underflow.
    for (const double alpha : alphas)
        alphas_.push_back(largest > 0 ? float(alpha / largest * ClassTable::kMax) : 0);
    unitsOfOpaque_ = largest > 0 ? float(ClassTable::kMax / largest) : 0;
    for (const Look& look : classes.looks)
        opacities_.push_back(float(-portable::expm1(-look.extinction)));
    for (int c = 0; c < 3; ++c) {
        const bool isSeen = brightest[c] > 0 && scale_[c] > 0;
        shares_[c] = isSeen ? float(std::min(1 / brightest[c], double(kMostShare))) : 0;
    }
}

void VoxelUnits::raise(const glm::dvec4& most) {
    glm::dvec4 shrunk(0);
    for (int c = 0; c < 4; ++c) {
        const double scale = std::max(scale_[c], most[c] / double(ClassTable::kMax));
        shrunk[c] = scale > 0 ? scale_[c] / scale : 1;
        scale_[c] = scale;
    }
    for (float& alpha : alphas_) alpha = float(alpha * shrunk.a);
    unitsOfOpaque_ = scale_.a > 0 ? float(1 / scale_.a) : 0;
    for (int c = 0; c < 3; ++c)
        shares_[c] = shrunk.a > 0 ? float(shares_[c] * shrunk[c] / shrunk.a) : 0;
}

glm::vec4 VoxelUnits::unitsOf(std::uint16_t number, const glm::vec3& color) const {
    const float alpha = alphaOf(number);
    glm::vec4 units(0, 0, 0, alpha);
    for (int c = 0; c < 3; ++c) units[c] = std::min(color[c] * shares_[c], kMostShare) * alpha;
    return units;
}

std::vector<glm::vec4> VoxelUnits::unitsOfClasses(const ClassTable& classes) const {
    std::vector<glm::vec4> colors;
    for (std::size_t number = 0; number < classes.looks.size(); ++number)
        colors.push_back(unitsOf(std::uint16_t(number), glm::vec3(classes.looks[number].color)));
    return colors;
}

std::vector<double> depthsOf(const ClassTable& classes, double wayWorld) {
    const double unitDistances = classes.extinctionScale * (wayWorld / classes.unitDistanceWorld);
    std::vector<double> depths;
    for (const Look& look : classes.looks) {
        // 0 times infinity must be 0.
        const bool isAny = unitDistances > 0 && look.extinction > 0;
        depths.push_back(isAny ? look.extinction * unitDistances : 0);
    }
    return depths;
}

glm::dvec3 brightestOf(const ClassTable& classes) {
    glm::dvec3 brightest(0);
    for (const Look& look : classes.looks) brightest = glm::max(brightest, look.color);
    return brightest;
}

}  // namespace deltasplat
