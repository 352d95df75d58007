// SPDX-License-Identifier: Apache-2.0
#include "lighting/reflected_light.h"
#include "base/affine.h"
#include "volume/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
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
    const glm::dmat3 world = glm::dmat3(volume.worldFromIndex) / smallestSize(volume);
    return glm::mat3(glm::transpose(glm::inverse(world)));
}

}  // namespace deltasplat
