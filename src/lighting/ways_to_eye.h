// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// The ways to an eye, or a light, from a word's voxels, of any length: `first + u * alongU + v *
/// alongV`.
struct WaysToEye {
    glm::vec3 first;
    glm::vec3 alongU;
    glm::vec3 alongV;
};

/// An eye and the voxels that it sees, which finds these ways.
class EyeOfVoxels {
  public:
    /// @param worldFromVoxel  of (slice, u, v)
    /// @param unitWorld       that ways are stated in
    EyeOfVoxels(const glm::dvec3& eyeWorld, const glm::dmat4& worldFromVoxel, double unitWorld = 1)
        : eye_(glm::inverse(worldFromVoxel) * glm::dvec4(eyeWorld, 1)),
          steps_(glm::dmat3(worldFromVoxel) / unitWorld) {}

    /// @param place  of the word's first voxel
    WaysToEye waysFrom(const glm::ivec3& place) const {
        return {glm::vec3(steps_ * (eye_ - glm::dvec3(place))), glm::vec3(-steps_[1]),
                glm::vec3(-steps_[2])};
    }

    bool operator==(const EyeOfVoxels&) const = default;

  private:
    glm::dvec3 eye_;    // (slice, u, v)
    glm::dmat3 steps_;  // in units of the world, along these
};

}  // namespace deltasplat
