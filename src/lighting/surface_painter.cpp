// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "lighting/reflected_light.h"
#include "optics/scaled_values.h"
#include "optics/voxel_painter.h"

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

// Looks are directions out of what is inside, and heights of voxels above its surface.
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
    int heightOfSurface() const override { return int(kMostDepth * kHeightSteps); }
    bool dependsOnCamera() const override { return true; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace& place, const BlockField* field,
               std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        glm::vec3 size(0);  // of a voxel, along x, y and z; each is along one of them
        for (int i = 0; i < 3; ++i) size += glm::abs(glm::vec3(place.steps[i]));
        const auto& [gx, gy, gz] = field->gradients;
        for (std::size_t n = 0; n < looks.size(); ++n) {
            const float value = field->values[n];
            const glm::vec3 steps(gx[n] * size.x, gy[n] * size.y, gz[n] * size.z);
            const int height = heightOf(value, std::sqrt(glm::dot(steps, steps)));
            classes[n] = height < OwnLook::kAll ? 1 : 0;
            looks[n] = {};
            looks[n].height = std::uint8_t(height);
            if (height == 0 || height == OwnLook::kAll) continue;
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
    // OwnLook::height of a voxel, if values change evenly.
    // @param step  by how much, across a voxel
    static int heightOf(float value, float step) {
        if (!(value == value)) return OwnLook::kAll;
        if (!(step > 0)) return value >= 0 ? 0 : OwnLook::kAll;
        const float depth = std::clamp(value / step, -kMostHeight, kMostDepth);
        return int((kMostDepth - depth) * kHeightSteps + 0.5f);
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
