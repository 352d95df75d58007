// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "deltasplat/optics/default_ramp.h"
#include "optics/painters.h"
#include "optics/reflection_kernels.h"

namespace deltasplat {
namespace {

// Far more than any gradient that counts, and its square is a float.
constexpr double kSteepest = 1e15;

// The gradient that is half noise, half surface: of the way between where most values lie. Whatever
// is beyond them does not count.
constexpr double kShareOfNoise = 0.01;

double noiseOf(const Volume& volume) {
    const glm::dvec2 bulk = bulkRange(volume);
    const double most = kShareOfNoise * (bulk.y - bulk.x);
    if (most > 0) return most;
    const double all = kShareOfNoise * (0.5 * volume.valueMax - 0.5 * volume.valueMin);
    return all > 0 ? all : 1;
}

// The most that any voxel reflects.
glm::dvec3 brightestOf(const Shading& shading, const ClassTable& classes) {
    glm::dvec3 own(0);
    for (const Look& look : classes.looks) own = glm::max(own, look.color);
    glm::dvec3 intensity(0);
    for (const Light& light : shading.lights) intensity += light.strength * light.color;
    return own * (shading.ambient + shading.diffuse * intensity) + shading.specular * intensity;
}

// The way to a light, of length 1.
glm::dvec3 towards(const Light& light, const Camera& camera) {
    if (light.frame == LightFrame::kHead) return -camera.direction;
    // Of any length, so that its square may be no number.
    const glm::dvec3 size = glm::abs(light.direction);
    const glm::dvec3 way = -glm::normalize(light.direction / std::max({size.x, size.y, size.z}));
    if (light.frame == LightFrame::kWorld) return way;
    return way.x * camera.right + way.y * camera.up - way.z * camera.direction;
}

// What surfaces reflect towards a camera.
class ReflectedLight : public LookLight {
  public:
    ReflectedLight(const Shading& shading, const ClassTable& classes, const LitScene& scene)
        : LookLight(VoxelUnits(classes, brightestOf(shading, classes))) {
        const Camera& camera = scene.camera;
        const glm::dvec3 toCamera = -camera.direction;
        const glm::dvec3 shares(units().shares());
        reflection_.ambient = float(shading.ambient);
        reflection_.shininess = float(shading.shininess);
        reflection_.hasSpecular = shading.specular > 0;
        reflection_.fromEye = camera.projection != Projection::kOrtho;
        reflection_.toCamera = glm::vec3(toCamera);
        for (const Light& light : shading.lights) {
            const glm::dvec3 intensity = light.strength * light.color;
            const glm::dvec3 toLight = towards(light, camera);
            reflection_.rays.push_back({light.frame == LightFrame::kHead, glm::vec3(toLight),
                                        halfWay(toLight, toCamera),
                                        glm::vec3(shading.diffuse * intensity),
                                        glm::vec3(shading.specular * intensity * shares)});
        }
        for (std::size_t number = 0; number < classes.looks.size(); ++number) {
            const auto one = std::uint16_t(number);
            colors_.push_back(units().unitsOf(one, glm::vec3(classes.looks[number].color)));
        }
        if (!reflection_.fromEye) return;
        eye_ = glm::dvec3(glm::inverse(scene.worldFromVoxel) * glm::dvec4(camera.eyeWorld(), 1));
        steps_ = glm::dmat3(scene.worldFromVoxel);
    }

    void light(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
               WordUnits& colors) const override {
        WordToLight word{colors_.data(), classes, looks, nullptr};
        if (!reflection_.fromEye) return reflect(reflection_, word, colors);
        const WaysToEye ways{glm::vec3(steps_ * (eye_ - glm::dvec3(place))), glm::vec3(-steps_[1]),
                             glm::vec3(-steps_[2])};
        word.ways = &ways;
        reflect(reflection_, word, colors);
    }

  private:
    // Of length 1; of ways that are opposite there is none.
    static glm::vec3 halfWay(const glm::dvec3& a, const glm::dvec3& b) {
        const double length = glm::length(a + b);
        return glm::vec3(length > 0 ? (a + b) / length : glm::dvec3(0));
    }

    Reflection reflection_;
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
    // Of an eye, (slice, u, v), and of voxels, steps along these in the world.
    glm::dvec3 eye_{0.0};
    glm::dmat3 steps_{1.0};
};

// Looks are gradients in the world, of length kMostSlope where all is surface.
class ShadingPainter : public VoxelPainter {
  public:
    ShadingPainter(const Volume& volume, const Shading& shading) : shading_(shading) {
        const double noise = noiseOf(volume);
        const double middle = 0.5 * volume.valueMin + 0.5 * volume.valueMax;
        const auto scaled = [&](double value) {
            return float(std::clamp((value - middle) / noise, -kSteepest, kSteepest));
        };
        scale_.ofCode.resize(kCodeCount);
        for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
            if (volume.histogram[code] != 0)
                scale_.ofCode[code] = scaled(volume.codeBook.valueOf(Code(code)));
        }
        if (volume.hasBackground) scale_.background = scaled(volume.background);
        const glm::dvec3 size = volume.voxelSize();
        const glm::dmat3 world =
            glm::dmat3(volume.worldFromIndex) / std::min({size.x, size.y, size.z});
        worldFromGradient_ = glm::mat3(glm::transpose(glm::inverse(world)));
    }

    bool needsColors() const override { return true; }
    bool dependsOnCamera() const override { return true; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace&, const BlockGradients* gradients,
               std::span<const std::uint16_t, 512>, std::span<OwnLook, 512> looks) const override {
        const glm::mat3& m = worldFromGradient_;
        const auto& [gx, gy, gz] = *gradients;
        for (std::size_t n = 0; n < looks.size(); ++n) {
            const glm::vec3 gradient(m[0].x * gx[n] + m[1].x * gy[n] + m[2].x * gz[n],
                                     m[0].y * gx[n] + m[1].y * gy[n] + m[2].y * gz[n],
                                     m[0].z * gx[n] + m[1].z * gy[n] + m[2].z * gz[n]);
            const float square =
                gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z;
            const float share = kMostSlope * std::sqrt(square) / (square + 1);
            for (int c = 0; c < 3; ++c)
                looks[n].bits[std::size_t(c)] = std::uint16_t(rounded(share * gradient[c]));
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        return std::make_unique<ReflectedLight>(shading_, classes, *scene);
    }

  private:
    // To the nearest, and of what mirrors each other to what mirrors each other.
    static std::int16_t rounded(float x) {
        return std::int16_t(std::int32_t(x + std::copysign(0.5f, x)));
    }

    Shading shading_;
    GradientScale scale_;
    glm::mat3 worldFromGradient_;  // of gradients per smallest voxel size
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading) {
    return std::make_unique<ShadingPainter>(volume, shading);
}

std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, const Optics& optics) {
    if (volume.empty()) return nullptr;
    if (optics.colorBy != ColorBy::kValue) return makePositionPainter(volume, optics.colorBy);
    return optics.shading ? makeShadingPainter(volume, *optics.shading) : nullptr;
}

}  // namespace deltasplat
