// SPDX-License-Identifier: Apache-2.0
#include "lighting/surface_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "base/affine.h"
#include "base/text.h"
#include "optics/value_colors.h"
#include "optics/voxel_painter.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

// Looks are gradients in the world, of length kMostSlope on full surfaces.
class ShadingPainter : public VoxelPainter {
  public:
    ShadingPainter(const Volume& volume, const Shading& shading)
        : shading_(shading),
          scale_(scaledValues(volume, 0.5 * volume.valueMin() + 0.5 * volume.valueMax(),
                              shading.noise)),
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
    glm::mat3 worldFromGradient_;  // to gradients per smallest voxel size
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading) {
    return std::make_unique<ShadingPainter>(volume, shading);
}

namespace {

// One colour from all sides.
Shading unlit() {
    Shading shading;
    shading.ambient = 1;
    shading.diffuse = 0;
    shading.specular = 0;
    shading.lights.clear();
    return shading;
}

// Looks are directions out of the inside, and heights of voxels above the surface.
class SurfacePainter : public VoxelPainter {
  public:
    SurfacePainter(const Volume& volume, const Surface& surface, const Shading& shading)
        : shading_(shading),
          scale_(scaledValues(volume, surface.isovalue, shading.noise)),
          worldFromGradient_(worldFromIndexGradient(volume)) {
        scale_.withValues = true;
        if (isLevelSet(volume)) {
            for (float& value : scale_.ofCode) value = -value;
            // Inactive voxels may also be far inside.
            scale_.background.reset();
        } else if (scale_.background && *scale_.background >= 0) {
            // Inactive voxels cannot all be shown: the surface ends where they begin.
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
        glm::vec3 size(0);  // of a voxel along x, y and z; each step is along one of them
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
    // OwnLook::height of a voxel if values change evenly, by `step` across a voxel.
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
    return volume.gridClass() == "level set" && !volume.fromLevelSet();
}

std::unique_ptr<const VoxelPainter> makeSurfacePainter(const Volume& volume, const Surface& surface,
                                                       const std::optional<Shading>& shading) {
    return std::make_unique<SurfacePainter>(volume, surface, shading.value_or(unlit()));
}

namespace {

// Upper bound of the reflected light.
glm::dvec3 brightestOf(const Shading& shading, const ClassTable& classes) {
    glm::dvec3 intensity(0);
    for (const Light& light : shading.lights) intensity += light.strength * light.color;
    return brightestOf(classes) * (shading.ambient + shading.diffuse * intensity) +
           shading.specular * intensity;
}

glm::dvec3 towards(const Light& light, const Camera& camera) {
    if (light.frame == LightFrame::kHead) return -camera.direction;
    const glm::dvec3 way = -unitVectorOf(light.direction);
    if (light.frame == LightFrame::kWorld) return way;
    return way.x * camera.right + way.y * camera.up - way.z * camera.direction;
}

// Of length 1; 0 if the ways are opposite.
glm::vec3 halfWay(const glm::dvec3& a, const glm::dvec3& b) {
    const double length = glm::length(a + b);
    return glm::vec3(length > 0 ? (a + b) / length : glm::dvec3(0));
}

CutVoxels cutVoxelsOf(const LitScene& scene) {
    const glm::dmat3 steps(scene.worldFromVoxel);
    const double unit = glm::length(steps[0]);
    const glm::dmat3 voxelFromWorld = glm::inverse(steps / unit);
    CutVoxels cut;
    for (int i = 0; i < 3; ++i) cut.steps[std::size_t(i)] = glm::vec3(steps[i] / unit);
    cut.perSlice = glm::vec3(glm::row(voxelFromWorld, 0));
    cut.blur = glm::vec3(scene.blur);
    return cut;
}

}  // namespace

ReflectedLight::ReflectedLight(const Shading& shading, const ClassTable& classes,
                               const LitScene& scene, bool isSolid)
    : LookLight(VoxelUnits(classes, brightestOf(shading, classes))),
      colors_(units().unitsOfClasses(classes)) {
    const Camera& camera = scene.camera;
    const glm::dvec3 toCamera = -camera.direction;
    const glm::dvec3 shares(units().shares());
    reflection_.ambient = float(shading.ambient);
    reflection_.shininess = float(shading.shininess);
    reflection_.hasSpecular = shading.specular > 0;
    if (isSolid) reflection_.cut = cutVoxelsOf(scene);
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
    if (reflection_.fromEye) eye_.emplace(camera.eyeWorld(), scene.worldFromVoxel);
}

void ReflectedLight::lightVoxels(const WordPlace& place, const std::uint16_t* classes,
                                 const OwnLook* looks, WordUnits& colors) const {
    WordToLight word{colors_.data(), classes, looks, nullptr};
    if (!eye_) return reflect(reflection_, word, colors);
    const WaysToEye ways = eye_->waysFrom(place);
    word.ways = &ways;
    reflect(reflection_, word, colors);
}

glm::mat3 worldFromIndexGradient(const Volume& volume) {
    const glm::dmat3 world = glm::dmat3(volume.worldFromIndex()) / smallestSize(volume);
    return glm::mat3(glm::transpose(glm::inverse(world)));
}

namespace {

// Adds to looks how much voxels fade.
class FadingPainter : public VoxelPainter {
  public:
    // @param inner  painter of the looks; null: voxels look like their classes
    FadingPainter(const Volume& volume, std::vector<glm::dvec2> factors,
                  std::unique_ptr<const VoxelPainter> inner)
        : inner_(std::move(inner)),
          scale_(inner_ && inner_->gradientScale()
                     ? *inner_->gradientScale()
                     : scaledValues(volume, 0.5 * volume.valueMin() + 0.5 * volume.valueMax())),
          worldFromGradient_(worldFromIndexGradient(volume)),
          factors_(std::move(factors)) {
        unit_ = scale_.unit / smallestSize(volume);
    }

    bool needsColors() const override { return !inner_ || inner_->needsColors(); }
    bool dependsOnCamera() const override { return inner_ && inner_->dependsOnCamera(); }
    bool mayHold() const override { return false; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace& place, const BlockField* field,
               std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        if (inner_) inner_->paint(place, field, classes, looks);
        for (std::size_t n = 0; n < looks.size(); ++n) {
            if (classes[n] == 0) continue;
            const glm::dvec3 gradient(worldGradient(worldFromGradient_, *field, n));
            const double factor = factorAt(unit_ * std::sqrt(glm::dot(gradient, gradient)));
            const int left = int(factor * OwnLook::kAll + 0.5);
            looks[n].faded = std::uint8_t(OwnLook::kAll - left);
            if (left == 0) classes[n] = 0;
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        if (inner_) return inner_->lightOf(classes, scene);
        return std::make_unique<ClassLight>(classes);
    }

  private:
    double factorAt(double gradient) const {
        const auto behind =
            std::upper_bound(factors_.begin(), factors_.end(), gradient,
                             [](double place, const glm::dvec2& point) { return place < point.x; });
        if (behind == factors_.begin()) return factors_.front().y;
        if (behind == factors_.end()) return factors_.back().y;
        const glm::dvec2 before = behind[-1];
        const double share = (gradient - before.x) / (behind->x - before.x);
        return before.y + share * (behind->y - before.y);
    }

    std::unique_ptr<const VoxelPainter> inner_;
    GradientScale scale_;
    glm::mat3 worldFromGradient_;
    std::vector<glm::dvec2> factors_;
    double unit_;  // data units per world unit for a gradient of length 1
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeFadingPainter(const Volume& volume,
                                                      const std::vector<glm::dvec2>& factors,
                                                      std::unique_ptr<const VoxelPainter> inner) {
    return std::make_unique<FadingPainter>(volume, factors, std::move(inner));
}

namespace {

// Looks are colours (lookOfColor).
class OwnColors : public LookLight {
  public:
    explicit OwnColors(const ClassTable& classes) : LookLight(VoxelUnits(classes, glm::dvec3(1))) {}

  protected:
    void lightVoxels(const WordPlace&, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override {
        for (std::size_t n = 0; n < 64; ++n) {
            const glm::vec4 color = units().unitsOf(classes[n], glm::vec3(colorOfLook(looks[n])));
            for (int c = 0; c < 4; ++c) colors[std::size_t(c)][n] = color[c];
        }
    }
};

// Colours that change evenly from one end of the volume to the other.
class PositionPainter : public VoxelPainter {
  public:
    // Channel c is slopes[c] * index position + starts[c], 0..1.
    PositionPainter(const glm::dmat3& slopes, const glm::dvec3& starts)
        : slopes_(slopes), starts_(starts) {}

    bool needsColors() const override { return false; }
    bool dependsOnCamera() const override { return false; }

    void paint(const BlockPlace& place, const BlockField*, std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        for (std::size_t n = 0; n < looks.size(); ++n) {
            if (classes[n] == 0) continue;
            const glm::dvec3 steps(glm::ivec3(n / 64, n / 8 % 8, n % 8));
            const glm::dvec3 index = place.first + place.steps * steps;
            glm::dvec3 color;
            for (int c = 0; c < 3; ++c) color[c] = glm::dot(slopes_[c], index) + starts_[c];
            looks[n] = lookOfColor(glm::clamp(color, 0.0, 1.0));
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene*) const override {
        return std::make_unique<OwnColors>(classes);
    }

  private:
    glm::dmat3 slopes_;  // [channel]
    glm::dvec3 starts_;
};

// A linear function: slope * index position + start.
struct Share {
    glm::dvec3 slope{0.0};
    double start = 0;
};

// Position, 0..1, from the lowest to the highest voxel centre along `slope`; 0 if all coincide.
Share shareAlong(const glm::dvec3& slope, const IndexBox& box) {
    double low = 0;
    double high = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double ends[] = {slope[axis] * box.min[axis], slope[axis] * box.max[axis]};
        low += std::min(ends[0], ends[1]);
        high += std::max(ends[0], ends[1]);
    }
    const Share share{slope / (high - low), -low / (high - low)};
    const double sum = share.slope.x + share.slope.y + share.slope.z + share.start;
    return high - low > 0 && std::isfinite(sum) ? share : Share{};
}

}  // namespace

std::string colorByName(ColorBy colorBy) {
    return enumName(colorBy, {"value", "x", "y", "z", "index"});
}

std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy) {
    glm::dmat3 slopes(0.0);
    glm::dvec3 starts(0.0);
    const auto setChannel = [&](int channel, const Share& share) {
        slopes[channel] = share.slope;
        starts[channel] = share.start;
    };
    if (colorBy == ColorBy::kIndex) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 along(0.0);
            along[axis] = 1;
            setChannel(axis, shareAlong(along, volume.box()));
        }
    } else {
        const int axis = int(colorBy) - int(ColorBy::kX);
        const glm::dmat4& world = volume.worldFromIndex();
        const Share share =
            shareAlong({world[0][axis], world[1][axis], world[2][axis]}, volume.box());
        setChannel(0, share);
        setChannel(2, {-share.slope, 1 - share.start});
    }
    return std::make_unique<PositionPainter>(slopes, starts);
}

}  // namespace deltasplat
