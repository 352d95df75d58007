// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <memory>
#include <optional>

#include "floor_div.h"
#include "ingest/codes/leaf_slices.h"
#include "light/light_depths.h"
#include "optics/painters.h"
#include "optics/scatter_kernels.h"
#include "unit_vector.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// Lights that shine at all.
std::vector<Light> shiningOf(const Scattering& scattering) {
    std::vector<Light> shining;
    for (const Light& light : scattering.lights) {
        const glm::dvec3 intensity = light.strength * light.color;
        if (std::max({intensity.x, intensity.y, intensity.z}) > 0) shining.push_back(light);
    }
    return shining;
}

// What fog scatters towards a camera. Where its voxels lie says all: looks are of no use.
class ScatteredLight : public LookLight {
  public:
    ScatteredLight(const Scattering& scattering, const std::vector<Light>& lights,
                   const LightDepths& depths, const ClassTable& classes, const LitScene& scene)
        : LookLight(VoxelUnits(classes, brightestOf(scattering, lights, classes, scene.camera)),
                    dimmestOf(scattering, scene.camera)),
          depths_(depths),
          sliceAxis_(scene.sliceAxis),
          colors_(units().unitsOfClasses(classes)) {
        sums_.ambient = glm::vec3(scattering.albedo * scattering.ambient);
        sums_.phases = phasesOf(scattering);
        const Camera& camera = scene.camera;
        for (const Light& light : lights) {
            const glm::dvec3 color = scattering.albedo * light.strength * light.color;
            ScatterRay ray{glm::vec3(unitVectorOf(light.direction)),
                           glm::vec3(color),
                           float(cosineOf(light, camera)),
                           {}};
            for (const ScatterPhase& phase : sums_.phases)
                ray.towardsCamera.push_back(glm::vec3(color * phase.at(cosineOf(light, camera))));
            sums_.rays.push_back(std::move(ray));
        }
        for (const double depth : depthsOf(classes, classes.stepWorld))
            own_.push_back(ownLight(depth));
        if (camera.projection != Projection::kOrtho)
            eye_.emplace(camera.eyeWorld(), scene.worldFromVoxel);
    }

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook*,
                     WordUnits& colors) const override {
        std::array<std::uint16_t, 64 * kMostAtOnce> few;
        std::vector<std::uint16_t> many;
        std::uint16_t* depths = few.data();
        if (sums_.rays.size() > kMostAtOnce) {
            many.resize(64 * sums_.rays.size());
            depths = many.data();
        }
        readDepths(place, depths);
        ScatterWord word{colors_.data(), own_.data(), classes, depths, nullptr};
        if (!eye_) return scatter(sums_, word, colors);
        const WaysToEye ways = eye_->waysFrom(place);
        word.ways = &ways;
        scatter(sums_, word, colors);
    }

  private:
    static constexpr std::size_t kMostAtOnce = 64;

    // Of where light goes and where it goes on to.
    static double cosineOf(const Light& light, const Camera& camera) {
        return glm::dot(unitVectorOf(light.direction), -camera.direction);
    }

    // What a light shows at least, for what it shows at most.
    static double dimmestOf(const Scattering& scattering, const Camera& camera) {
        if (camera.projection == Projection::kOrtho) return 1;
        const ScatterPhase phase = phasesOf(scattering).front();
        return phase.smallest() / phase.largest();
    }

    // The most that any voxel scatters.
    static glm::dvec3 brightestOf(const Scattering& scattering, const std::vector<Light>& lights,
                                  const ClassTable& classes, const Camera& camera) {
        const bool isParallel = camera.projection == Projection::kOrtho;
        glm::dvec3 brightest = scattering.ambient;
        for (const ScatterPhase& phase : phasesOf(scattering)) {
            for (const Light& light : lights) {
                const double share =
                    isParallel ? phase.at(cosineOf(light, camera)) : phase.largest();
                brightest += share * light.strength * light.color;
            }
        }
        return scattering.albedo * brightest * deltasplat::brightestOf(classes);
    }

    // Reads those of a word's voxels, [lights][u][v]. Of what cannot be seen they may be anything.
    void readDepths(const WordPlace& place, std::uint16_t* depths) const {
        const glm::ivec3 block(floorDiv(place.x, 8), floorDiv(place.y, 8), floorDiv(place.z, 8));
        const std::int64_t number = depths_.blocks().find(fromSliceOrder(block, sliceAxis_));
        if (number < 0) {
            std::fill_n(depths, 64 * sums_.rays.size(), std::uint16_t{0});
            return;
        }
        const glm::ivec3 stride = toSliceOrder(kLeafStride, sliceAxis_);
        for (std::size_t light = 0; light < sums_.rays.size(); ++light) {
            const std::uint16_t* first =
                depths_.of(light, number) + (place.x - 8 * block.x) * stride.x;
            for (int u = 0; u < 8; ++u) {
                for (int v = 0; v < 8; ++v) *depths++ = first[u * stride.y + v * stride.z];
            }
        }
    }

    const LightDepths& depths_;
    int sliceAxis_;
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
    std::vector<glm::vec4> own_;     // [classes]: ownLight()
    ScatterSums sums_;
    std::optional<EyeOfVoxels> eye_;
};

class ScatterPainter : public VoxelPainter {
  public:
    ScatterPainter(const Volume& volume, const Optics& optics)
        : scattering_(*optics.scattering),
          lights_(shiningOf(scattering_)),
          classes_(classify(volume, optics, smallestSize(volume))),
          depths_(volume, classes_, lights_, scattering_.octaves) {}

    bool needsColors() const override { return true; }
    bool dependsOnCamera() const override { return true; }
    bool isEverywhereOther() const override { return true; }

    void paint(const BlockPlace&, const BlockField*, std::span<std::uint16_t, 512>,
               std::span<OwnLook, 512> looks) const override {
        std::fill(looks.begin(), looks.end(), OwnLook{});
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        return std::make_unique<ScatteredLight>(scattering_, lights_, depths_, classes, *scene);
    }

  private:
    Scattering scattering_;
    std::vector<Light> lights_;
    ClassTable classes_;
    LightDepths depths_;
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeScatterPainter(const Volume& volume, const Optics& optics) {
    return std::make_unique<ScatterPainter>(volume, optics);
}

}  // namespace deltasplat
