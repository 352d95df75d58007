// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "lighting/ways_to_eye.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// Largest component of a gradient in a look.
inline constexpr float kMostSlope = 32767;

/// A light from one direction everywhere, or from the camera.
struct Ray {
    bool fromCamera;     ///< if true, all vectors point to the camera
    glm::vec3 toLight;   ///< of length 1
    glm::vec3 half;      ///< half-way to the camera, of length 1; for parallel lines of sight
    glm::vec3 diffuse;   ///< colour * strength * diffuse share
    glm::vec3 specular;  ///< likewise for highlights, in VoxelUnits for an alpha of 1

    bool operator==(const Ray&) const = default;
};

/// Heights (OwnLook) above a surface are in voxel sizes along the normal (root of the sum of
/// squared edges along it). From kMostHeight on a voxel is invisible; height 0 is kMostDepth below.
inline constexpr float kMostHeight = 1.5;
inline constexpr float kMostDepth = 3;
/// Steps of OwnLook::height per voxel size.
inline constexpr float kHeightSteps = OwnLook::kAll / (kMostHeight + kMostDepth);

/// Geometry for the opacity of voxels at or below a surface.
struct CutVoxels {
    /// From one voxel to the next along slice, u and v, in the world, in any unit.
    std::array<glm::vec3, 3> steps;
    glm::vec3 perSlice;  ///< dot product with a way in that unit: number of slices
    glm::vec3 blur;      ///< LitScene::blur

    bool operator==(const CutVoxels&) const = default;
};

struct Reflection {
    float ambient;
    float shininess;
    bool hasSpecular;
    std::vector<Ray> rays;
    /// Set if gradients point out of a solid; otherwise both sides of a gradient can be seen.
    std::optional<CutVoxels> cut;
    bool fromEye;        ///< each voxel has its own way to the camera
    glm::vec3 toCamera;  ///< of length 1; unused if `fromEye`

    bool operator==(const Reflection&) const = default;
};

struct WordToLight {
    const glm::vec4* colors;       ///< of classes, premultiplied
    const std::uint16_t* classes;  ///< [64]
    /// [64]: gradients in the world, of length kMostSlope times the shaded share
    const OwnLook* looks;
    const WaysToEye* ways;  ///< null unless `fromEye`
};

/// Returns the premultiplied reflected colours. The same bits at every SIMD level.
void reflect(const Reflection& reflection, const WordToLight& word, WordUnits& units);

}  // namespace deltasplat
