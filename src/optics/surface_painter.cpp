// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/painters.h"
#include "optics/reflected_light.h"
#include "optics/scaled_values.h"

namespace deltasplat {
namespace {

// One colour from everywhere.
Shading unlit() {
    Shading shading;
    shading.ambient = 1;
    shading.diffuse = 0;
    shading.specular = 0;
    shading.lights.clear();
    return shading;
}

// Looks are directions out of what is inside, and how much of a voxel lies outside.
class SurfacePainter : public VoxelPainter {
  public:
    SurfacePainter(const Volume& volume, const Surface& surface, const Shading& shading)
        : shading_(shading),
          scale_(scaledValues(volume, surface.isovalue, shading.noise)),
          worldFromGradient_(worldFromIndexGradient(volume)) {
        scale_.withValues = true;
        if (isLevelSet(volume)) {
            for (float& value : scale_.ofCode) value = -value;
            // What is not active may be far inside as well.
            scale_.background.reset();
        } else if (scale_.background && *scale_.background >= 0) {
            // Not all of what is not active can be shown: the surface ends where it begins.
            scale_.background.reset();
        }
    }

    bool needsColors() const override { return true; }
    bool choosesClasses() const override { return true; }
    bool isSeenItself(Code code) const override { return scale_.ofCode[code] >= 0; }
    bool dependsOnCamera() const override { return true; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace& place, const BlockField* field,
               std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        glm::vec3 size(0);  // of a voxel, along x, y and z
        for (int i = 0; i < 3; ++i) size += glm::abs(glm::vec3(place.steps[i]));
        const auto& [gx, gy, gz] = field->gradients;
        for (std::size_t n = 0; n < looks.size(); ++n) {
            const float value = field->values[n];
            // From the voxel's lowest corner to its highest.
            const float span =
                std::abs(gx[n]) * size.x + std::abs(gy[n]) * size.y + std::abs(gz[n]) * size.z;
            const glm::vec3 steps(gx[n] * size.x, gy[n] * size.y, gz[n] * size.z);
            const int inside = insideOf(value, span, std::sqrt(glm::dot(steps, steps)));
            classes[n] = inside > 0 ? 1 : 0;
            looks[n] = {};
            looks[n].missing = std::uint8_t(OwnLook::kAll - inside);
            if (inside == 0 || value > kDeep * span) continue;
            const glm::vec3 gradient = worldGradient(worldFromGradient_, *field, n);
            const float length = std::sqrt(gradient.x * gradient.x + gradient.y * gradient.y +
                                           gradient.z * gradient.z);
            if (length > 0) setSlope(looks[n], -kMostSlope / length * gradient);
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        return std::make_unique<ReflectedLight>(shading_, classes, *scene, /*isSolid=*/true);
    }

  private:
    // Voxels below the surface, from which on nothing of a voxel can be seen.
    static constexpr float kDeep = 3;
    // In voxels, how far the surface is moved inwards. Several slices show each some of what they
    // share with what is outside, which makes things look larger (docs/decisions.md).
    static constexpr float kInset = 0.45f;

    // The share of a voxel that lies inside, of OwnLook::kAll, if values change evenly.
    // @param step  what values change by across a voxel, along their gradient
    static int insideOf(float value, float span, float step) {
        if (!(value == value)) return 0;
        if (!(span > 0)) return value >= 0 ? OwnLook::kAll : 0;
        const float share = std::clamp((value - kInset * step) / span + 0.5f, 0.0f, 1.0f);
        return int(share * float(OwnLook::kAll) + 0.5f);
    }

    Shading shading_;
    GradientScale scale_;
    glm::mat3 worldFromGradient_;
};

}  // namespace

bool isLevelSet(const Volume& volume) {
    return volume.gridClass == "level set" && !volume.fromLevelSet;
}

std::unique_ptr<const VoxelPainter> makeSurfacePainter(const Volume& volume, const Surface& surface,
                                                       const std::optional<Shading>& shading) {
    return std::make_unique<SurfacePainter>(volume, surface, shading.value_or(unlit()));
}

}  // namespace deltasplat
