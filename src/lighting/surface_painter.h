// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "lighting/reflection_kernels.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// Reflected light of surfaces. Looks are gradients (setSlope).
class ReflectedLight : public LookLight {
  public:
    /// @param isSolid  whether only the surface is visible and gradients point out of it
    ReflectedLight(const Shading& shading, const ClassTable& classes, const LitScene& scene,
                   bool isSolid = false);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    Reflection reflection_;
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
    std::optional<EyeOfVoxels> eye_;
};

/// Returns the map from index gradients to world gradients per smallest voxel size.
glm::mat3 worldFromIndexGradient(const Volume& volume);

inline glm::vec3 worldGradient(const glm::mat3& worldFromIndex, const BlockField& field,
                               std::size_t n) {
    const glm::mat3& m = worldFromIndex;
    const auto& [gx, gy, gz] = field.gradients;
    return {m[0].x * gx[n] + m[1].x * gy[n] + m[2].x * gz[n],
            m[0].y * gx[n] + m[1].y * gy[n] + m[2].y * gz[n],
            m[0].z * gx[n] + m[1].z * gy[n] + m[2].z * gz[n]};
}

/// Stores a vector, of length kMostSlope times the shaded share, in a look. Rounds symmetrically,
/// so that mirrored vectors have mirrored looks.
inline void setSlope(OwnLook& look, const glm::vec3& slope) {
    for (int c = 0; c < 3; ++c) {
        const float nearest = slope[c] + std::copysign(0.5f, slope[c]);
        look.bits[std::size_t(c)] = std::uint16_t(std::int16_t(std::int32_t(nearest)));
    }
}

}  // namespace deltasplat
