// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Premultiplied colours of 64 voxels as channels of floats, RGBA, in units of VoxelUnits.
using WordUnits = std::array<std::array<float, 64>, 4>;

/// The units, those of a class table's first plane, in which voxels are stated that have looks of
/// their own.
class VoxelUnits {
  public:
    /// @param classes    of opacities
    /// @param brightest  no channel of any colour, not multiplied by opacity, is larger; finite, at
    ///                   least 0
    VoxelUnits(const ClassTable& classes, const glm::dvec3& brightest);

    /// Makes units large enough for what has other colours than its class, or another opacity.
    /// @param most  the largest premultiplied colour
    void raise(const glm::dvec4& most);

    const glm::dvec3& brightest() const { return brightest_; }
    /// Value of one unit of each channel on the first plane; 0 for one that is always 0.
    const glm::dvec4& scale() const { return scale_; }
    /// Returns the opacity of a class, 0..ClassTable::kMax.
    float alphaOf(std::uint16_t number) const { return alphas_[number]; }
    /// Returns the opacity of a class over a unit distance, 0..1.
    float opacityOf(std::uint16_t number) const { return opacities_[number]; }
    /// How many unit distances a step is, as extinction counts them.
    float unitDistances() const { return unitDistances_; }
    /// What alphaOf() an opacity of 1 would be.
    float unitsOfOpaque() const { return unitsOfOpaque_; }
    /// What a colour's channels are multiplied by to become shares of the brightest.
    const glm::vec3& shares() const { return shares_; }
    /// Returns the premultiplied colour of a voxel.
    /// @param number  of its class
    /// @param color   scene-linear, not multiplied by opacity; may be brighter than the brightest
    ///                where it is dimmed afterwards
    glm::vec4 unitsOf(std::uint16_t number, const glm::vec3& color) const;
    /// Returns the premultiplied colours of all classes, [classes], in their own colours.
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

/// Returns the extinction of each class on a way of so many world units, [classes]: 0 where there
/// is none, infinite where it is opaque.
std::vector<double> depthsOf(const ClassTable& classes, double wayWorld);

/// Returns the largest that any class has of each channel, not multiplied by opacity.
glm::dvec3 brightestOf(const ClassTable& classes);

}  // namespace deltasplat
