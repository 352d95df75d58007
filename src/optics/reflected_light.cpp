// SPDX-License-Identifier: Apache-2.0
#include "optics/reflected_light.h"
#include "deltasplat/splat/footprint.h"
#include "portable_math.h"
#include "unit_vector.h"
#include "view/affine.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace deltasplat {
namespace {

// The most that any voxel reflects.
glm::dvec3 brightestOf(const Shading& shading, const ClassTable& classes) {
    glm::dvec3 intensity(0);
    for (const Light& light : shading.lights) intensity += light.strength * light.color;
    return brightestOf(classes) * (shading.ambient + shading.diffuse * intensity) +
           shading.specular * intensity;
}

// The way to a light, of length 1.
glm::dvec3 towards(const Light& light, const Camera& camera) {
    if (light.frame == LightFrame::kHead) return -camera.direction;
    const glm::dvec3 way = -unitVectorOf(light.direction);
    if (light.frame == LightFrame::kWorld) return way;
    return way.x * camera.right + way.y * camera.up - way.z * camera.direction;
}

// Of length 1; of ways that are opposite there is none.
glm::vec3 halfWay(const glm::dvec3& a, const glm::dvec3& b) {
    const double length = glm::length(a + b);
    return glm::vec3(length > 0 ? (a + b) / length : glm::dvec3(0));
}

// How many pixels of the screen a voxel covers at most, seen in parallel.
double pixelsPerVoxel(const LitScene& scene) {
    const Camera& camera = scene.camera;
    const auto onScreen = [&](const glm::dvec3& step) {
        return glm::dvec2(glm::dot(step, camera.right) / camera.pixelWorld(),
                          glm::dot(step, camera.up) / camera.pixelHeightWorld());
    };
    const glm::dvec2 u = onScreen(glm::dvec3(scene.worldFromVoxel[1]));
    const glm::dvec2 v = onScreen(glm::dvec3(scene.worldFromVoxel[2]));
    const double mean = (glm::dot(u, u) + glm::dot(v, v)) / 2;
    return std::sqrt(mean + portable::hypot((glm::dot(u, u) - glm::dot(v, v)) / 2, glm::dot(u, v)));
}

// The variance of what a voxel is seen in along an axis of its sheet, in voxels: the footprint's,
// where nothing else is asked for.
double footprintVariance(double pixels) {
    if (hasOwnPixel(pixels, 1)) return 0;
    const double sigma = defaultSigma(pixels, 1);
    const double beside = portable::exp(-1 / (2 * sigma * sigma));
    return 2 * beside / (1 + 2 * beside);
}

// How much more of a voxel at an outline has to be missing, of OwnLook::kAll, for voxels beside
// each other share in what they show, of a slice that is read between them along an axis as well
// (docs/decisions.md).
int blurOfOutlines(const LitScene& scene) {
    constexpr double kWhole = 1e-6;
    constexpr double kReadBetween = 1.0 / 6;
    constexpr double kPerVariance = 0.75;
    const bool isParallel = scene.camera.projection == Projection::kOrtho;
    const glm::dvec3 step = glm::inverse(glm::dmat3(scene.worldFromVoxel)) * scene.camera.direction;
    double variance = isParallel ? footprintVariance(pixelsPerVoxel(scene)) : 0;
    for (const double along : {step.y / step.x, step.z / step.x}) {
        const bool isBetween = std::abs(along - std::round(along)) > kWhole;
        if (isBetween || !isParallel) variance += kReadBetween / 2;
    }
    return int(std::lround(kPerVariance * variance * OwnLook::kAll));
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
    reflection_.isSolid = isSolid;
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
    if (isSolid) setMoreMissing(blurOfOutlines(scene));
}

bool ReflectedLight::isLike(const LookLight& other) const {
    const auto* same = dynamic_cast<const ReflectedLight*>(&other);
    return same && moreMissing() == same->moreMissing() && units() == same->units() &&
           reflection_ == same->reflection_ && colors_ == same->colors_ && eye_ == same->eye_;
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
    const glm::dmat3 world = glm::dmat3(volume.worldFromIndex) / smallestSize(volume);
    return glm::mat3(glm::transpose(glm::inverse(world)));
}

}  // namespace deltasplat
