// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Premultiplied colours of 64 voxels by channel, RGBA, in VoxelUnits.
using WordUnits = std::array<std::array<float, 64>, 4>;

/// The units of colours of voxels with own looks, based on those of a class table's first plane.
class VoxelUnits {
  public:
    /// @param classes    give the opacities
    /// @param brightest  largest channels of all colours, not multiplied by opacity; finite, >= 0
    VoxelUnits(const ClassTable& classes, const glm::dvec3& brightest);

    /// Enlarges the units for voxels whose colour or opacity differs from their class.
    /// @param most  the largest premultiplied colour
    void raise(const glm::dvec4& most);

    const glm::dvec3& brightest() const { return brightest_; }
    /// Value of one unit per channel on the first plane; 0 for a channel that is always 0.
    const glm::dvec4& scale() const { return scale_; }
    float alphaOf(std::uint16_t number) const { return alphas_[number]; }
    /// Over a unit distance, 0..1.
    float opacityOf(std::uint16_t number) const { return opacities_[number]; }
    /// The length of a step in unit distances, with the extinction scale.
    float unitDistances() const { return unitDistances_; }
    /// The alphaOf() of a class of opacity 1.
    float unitsOfOpaque() const { return unitsOfOpaque_; }
    /// Factors that turn a colour's channels into shares of the brightest.
    const glm::vec3& shares() const { return shares_; }
    /// @param color  scene-linear, without opacity; above the brightest only if dimmed later
    glm::vec4 unitsOf(std::uint16_t number, const glm::vec3& color) const;
    /// [classes]
    std::vector<glm::vec4> unitsOfClasses(const ClassTable& classes) const;

    bool operator==(const VoxelUnits&) const = default;

  private:
    std::vector<float> alphas_;     // [classes]
    std::vector<float> opacities_;  // [classes]
    float unitDistances_;
    float unitsOfOpaque_;
    glm::dvec3 brightest_;
    glm::vec3 shares_;
    glm::dvec4 scale_;
};

/// Returns the extinction of each class over a way, [classes]; infinite if opaque.
std::vector<double> depthsOf(const ClassTable& classes, double wayWorld);

/// Returns the largest value per channel of any class' colour, not multiplied by opacity.
glm::dvec3 brightestOf(const ClassTable& classes);

}  // namespace deltasplat
