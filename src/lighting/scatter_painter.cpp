// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <optional>

#include "base/affine.h"
#include "base/bits.h"
#include "base/portable_math.h"
#include "lighting/light_depths.h"
#include "lighting/scatter_kernels.h"
#include "optics/color_space.h"
#include "optics/voxel_painter.h"
#include "volume/leaf_slices.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

std::vector<Light> shiningOf(const Scattering& scattering) {
    std::vector<Light> shining;
    for (const Light& light : scattering.lights) {
        const glm::dvec3 intensity = light.strength * light.color;
        if (std::max({intensity.x, intensity.y, intensity.z}) > 0) shining.push_back(light);
    }
    return shining;
}

// A light and its strength at voxels.
struct Shine {
    Light light;            // a point light has the strength of distance `unitWorld`
    double unitWorld = 1;   // least distance that matters for strength
    double leastShare = 1;  // of the strength, at any voxel

    bool isPoint() const { return light.positionWorld.has_value(); }
};

Shine shineOf(const Light& light, const LitBlocks::Reach& reach, const Volume& volume) {
    // Radius of a ball of volume 1 times sqrt(1/3): there 1 / r^2 has its mean over the ball.
    constexpr double kOwnVoxel = 0.35816;
    constexpr double kMost = 1e30;
    Shine shine{light};
    if (!light.positionWorld) return shine;
    const double size = std::abs(glm::determinant(glm::dmat3(volume.worldFromIndex())));
    const double voxel = portable::pow(size, 1.0 / 3);
    const double least = std::max(light.radiusWorld, kOwnVoxel * voxel);
    shine.unitWorld = std::max(least, reach.nearest);
    const double share = shine.unitWorld / std::max(shine.unitWorld, reach.farthest);
    shine.leastShare = share * share;
    shine.light.strength =
        std::min(light.strength / shine.unitWorld / shine.unitWorld, kMost / kMostLight);
    return shine;
}

// Fog's light towards a camera. It depends only on the places of voxels, not on looks.
class ScatteredLight : public LookLight {
  public:
    ScatteredLight(const Scattering& scattering, const std::vector<Shine>& shines,
                   const LightDepths& depths, const glm::dvec3* factor, const ClassTable& classes,
                   const LitScene& scene)
        : LookLight(
              VoxelUnits(classes, brightestOf(scattering, shines, factor, classes, scene.camera)),
              dimmestOf(scattering, shines, scene.camera) *
                  leastOfOctaves(scattering, shines, factor, classes, scene.camera)),
          depths_(depths),
          sliceAxis_(scene.sliceAxis),
          hasFactors_(factor != nullptr),
          colors_(units().unitsOfClasses(classes)) {
        const Camera& camera = scene.camera;
        sums_.ambient = glm::vec3(scattering.albedo * scattering.ambient);
        sums_.phases = phasesOf(scattering);
        sums_.toCamera = glm::vec3(-camera.direction);
        for (const Shine& shine : shines) {
            sums_.rays.push_back(rayOf(shine, scattering, camera));
            if (shine.isPoint())
                points_.emplace_back(*shine.light.positionWorld, scene.worldFromVoxel,
                                     shine.unitWorld);
        }
        for (const double depth : depthsOf(classes, classes.stepWorld))
            own_.push_back(ownLight(depth));
        const glm::dvec3 albedo = scattering.albedo * (factor ? *factor : glm::dvec3(1));
        for (const Look& look : classes.looks) sentOn_.emplace_back(albedo * look.color, 0);
        if (camera.projection != Projection::kOrtho)
            eye_.emplace(camera.eyeWorld(), scene.worldFromVoxel);
    }

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override {
        FewOrMany<std::uint16_t, 64 * kMostAtOnce> depths(64 * sums_.rays.size());
        readDepths(place, depths.data());
        FewOrMany<WaysToEye, kMostAtOnce> toLights(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i)
            toLights.data()[i] = points_[i].waysFrom(place);
        ScatterWord word{};
        word.colors = colors_.data();
        word.own = own_.data();
        word.sentOn = sentOn_.data();
        word.classes = classes;
        word.depths = depths.data();
        word.toLights = toLights.data();
        WordFactors factors;
        if (hasFactors_ && sums_.phases.size() > 1) {
            factors = factorsOf(looks);
            word.factors = &factors;
        }
        if (!eye_) return scatter(sums_, word, colors);
        const WaysToEye ways = eye_->waysFrom(place);
        word.ways = &ways;
        scatter(sums_, word, colors);
    }

  private:
    static constexpr std::size_t kMostAtOnce = 64;

    // Storage for elements, on the stack if they are few.
    template <typename T, std::size_t kFew>
    class FewOrMany {
      public:
        explicit FewOrMany(std::size_t size) {
            if (size > kFew) many_.resize(size);
        }
        T* data() { return many_.empty() ? few_.data() : many_.data(); }

      private:
        std::array<T, kFew> few_;
        std::vector<T> many_;
    };

    // Of the deflection.
    static double cosineOf(const Light& light, const Camera& camera) {
        return glm::dot(unitVectorOf(light.direction), -camera.direction);
    }

    ScatterRay rayOf(const Shine& shine, const Scattering& scattering, const Camera& camera) const {
        const Light& light = shine.light;
        const glm::dvec3 color = scattering.albedo * light.strength * light.color;
        ScatterRay ray{{}, glm::vec3(color), 0, {}, shine.isPoint()};
        if (shine.isPoint()) return ray;
        ray.way = glm::vec3(unitVectorOf(light.direction));
        ray.cosine = float(cosineOf(light, camera));
        for (const ScatterPhase& phase : sums_.phases)
            ray.towardsCamera.push_back(glm::vec3(color * phase.at(cosineOf(light, camera))));
        return ray;
    }

    // Ratio of the least to the largest light at any voxel.
    static double dimmestOf(const Scattering& scattering, const std::vector<Shine>& shines,
                            const Camera& camera) {
        const bool isAnyPoint = std::any_of(shines.begin(), shines.end(),
                                            [](const Shine& shine) { return shine.isPoint(); });
        if (!isAnyPoint && camera.projection == Projection::kOrtho) return 1;
        const ScatterPhase phase = phasesOf(scattering).front();
        const double turned = phase.smallest() / phase.largest();
        if (!isAnyPoint) return turned;
        glm::dvec3 least = scattering.ambient;
        glm::dvec3 most = scattering.ambient;
        for (const Shine& shine : shines) {
            const glm::dvec3 color = phase.largest() * shine.light.strength * shine.light.color;
            least += turned * shine.leastShare * color;
            most += color;
        }
        double dimmest = 1;
        for (int c = 0; c < 3; ++c)
            if (most[c] > 0) dimmest = std::min(dimmest, least[c] / most[c]);
        return dimmest;
    }

    // Upper bound of the share sent on per octave.
    static glm::dvec3 sentOnAtMost(const Scattering& scattering, const glm::dvec3* factor,
                                   const ClassTable& classes) {
        const glm::dvec3 share = scattering.albedo * deltasplat::brightestOf(classes);
        return glm::min(factor ? share * *factor : share, glm::dvec3(1));
    }

    // Upper bound of the light of octaves 0..octaves to the camera, without the voxel's colour.
    static glm::dvec3 turnedAtMost(const Scattering& scattering, const std::vector<Shine>& shines,
                                   const glm::dvec3& sentOn, const Camera& camera, int octaves) {
        const bool isParallel = camera.projection == Projection::kOrtho;
        const std::vector<ScatterPhase> phases = phasesOf(scattering);
        glm::dvec3 most = scattering.ambient;
        glm::dvec3 left(1);
        for (int octave = 0; octave <= octaves; ++octave, left *= sentOn) {
            const ScatterPhase& phase = phases[std::size_t(octave)];
            for (const Shine& shine : shines) {
                const bool isOneWay = isParallel && !shine.isPoint();
                const double share =
                    isOneWay ? phase.at(cosineOf(shine.light, camera)) : phase.largest();
                most += left * share * shine.light.strength * shine.light.color;
            }
        }
        return most;
    }

    static glm::dvec3 brightestOf(const Scattering& scattering, const std::vector<Shine>& shines,
                                  const glm::dvec3* factor, const ClassTable& classes,
                                  const Camera& camera) {
        return scattering.albedo * deltasplat::brightestOf(classes) *
               turnedAtMost(scattering, shines, sentOnAtMost(scattering, factor, classes), camera,
                            scattering.octaves);
    }

    // Dark voxels may send on almost nothing, and so have only the first octave.
    static double leastOfOctaves(const Scattering& scattering, const std::vector<Shine>& shines,
                                 const glm::dvec3* factor, const ClassTable& classes,
                                 const Camera& camera) {
        const glm::dvec3 sentOn = sentOnAtMost(scattering, factor, classes);
        const glm::dvec3 first = turnedAtMost(scattering, shines, sentOn, camera, 0);
        const glm::dvec3 all = turnedAtMost(scattering, shines, sentOn, camera, scattering.octaves);
        double least = 1;
        for (int c = 0; c < 3; ++c)
            if (all[c] > 0) least = std::min(least, first[c] / all[c]);
        return least;
    }

    // Reads the depths of a word's voxels, [lights][u][v]; undefined for invisible voxels.
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
    bool hasFactors_;
    std::vector<glm::vec4> colors_;  // [classes]: premultiplied
    std::vector<glm::vec4> own_;     // [classes]: ownLight()
    std::vector<glm::vec4> sentOn_;  // [classes]: ScatterWord::sentOn times the largest factor
    ScatterSums sums_;
    std::optional<EyeOfVoxels> eye_;
    std::vector<EyeOfVoxels> points_;  // the point lights
};

class ScatterPainter : public VoxelPainter {
  public:
    ScatterPainter(const Volume& volume, const Optics& optics)
        : scattering_(*optics.scattering),
          classes_(classify(volume, optics, smallestSize(volume))),
          depths_(volume, classes_, shiningOf(scattering_), scattering_.octaves) {
        if (optics.colorGrids) largestFactor_ = ColorFactor::largestOf(*optics.colorGrids);
        const std::vector<Light> lights = shiningOf(scattering_);
        for (std::size_t i = 0; i < lights.size(); ++i)
            shines_.push_back(shineOf(lights[i], depths_.reach(i), volume));
    }

    bool needsColors() const override { return true; }
    bool dependsOnCamera() const override { return true; }
    bool isEverywhereOther() const override { return true; }

    void paint(const BlockPlace&, const BlockField*, std::span<std::uint16_t, 512>,
               std::span<OwnLook, 512> looks) const override {
        std::fill(looks.begin(), looks.end(), OwnLook{});
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        return std::make_unique<ScatteredLight>(scattering_, shines_, depths_,
                                                largestFactor_ ? &*largestFactor_ : nullptr,
                                                classes, *scene);
    }

  private:
    Scattering scattering_;
    ClassTable classes_;
    LightDepths depths_;
    std::vector<Shine> shines_;                // in the order of `depths_`
    std::optional<glm::dvec3> largestFactor_;  // empty: voxels have class colours
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeScatterPainter(const Volume& volume, const Optics& optics) {
    return std::make_unique<ScatterPainter>(volume, optics);
}

}  // namespace deltasplat
