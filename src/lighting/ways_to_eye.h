// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace deltasplat {

/// Ways from a word's voxels to an eye or light, not normalized: `first + u alongU + v alongV`.
struct WaysToEye {
    glm::vec3 first;
    glm::vec3 alongU;
    glm::vec3 alongV;
};

/// An eye, or a light, in the order of voxels.
class EyeOfVoxels {
  public:
    /// @param worldFromVoxel  of (slice, u, v)
    /// @param unitWorld       unit of the ways
    EyeOfVoxels(const glm::dvec3& eyeWorld, const glm::dmat4& worldFromVoxel, double unitWorld = 1)
        : eye_(glm::inverse(worldFromVoxel) * glm::dvec4(eyeWorld, 1)),
          steps_(glm::dmat3(worldFromVoxel) / unitWorld) {}

    WaysToEye waysFrom(const glm::ivec3& place) const {
        return {glm::vec3(steps_ * (eye_ - glm::dvec3(place))), glm::vec3(-steps_[1]),
                glm::vec3(-steps_[2])};
    }

    bool operator==(const EyeOfVoxels&) const = default;

  private:
    glm::dvec3 eye_;    // (slice, u, v)
    glm::dmat3 steps_;  // world ways along slice, u and v, in units
};

}  // namespace deltasplat
