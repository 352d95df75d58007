// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/painters.h"
#include "optics/reflected_light.h"
#include "optics/scaled_values.h"

namespace deltasplat {
namespace {

// Looks are gradients in the world, of length kMostSlope where all is surface.
class ShadingPainter : public VoxelPainter {
  public:
    ShadingPainter(const Volume& volume, const Shading& shading)
        : shading_(shading),
          scale_(
              scaledValues(volume, 0.5 * volume.valueMin + 0.5 * volume.valueMax, shading.noise)),
          worldFromGradient_(worldFromIndexGradient(volume)) {}

    bool needsColors() const override { return true; }
    bool dependsOnCamera() const override { return true; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace&, const BlockField* field, std::span<std::uint16_t, 512>,
               std::span<OwnLook, 512> looks) const override {
        for (std::size_t n = 0; n < looks.size(); ++n) {
            const glm::vec3 gradient = worldGradient(worldFromGradient_, *field, n);
            const float square =
                gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z;
            setSlope(looks[n], kMostSlope * std::sqrt(square) / (square + 1) * gradient);
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        return std::make_unique<ReflectedLight>(shading_, classes, *scene);
    }

  private:
    Shading shading_;
    GradientScale scale_;
    glm::mat3 worldFromGradient_;  // of gradients per smallest voxel size
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading) {
    return std::make_unique<ShadingPainter>(volume, shading);
}

}  // namespace deltasplat
