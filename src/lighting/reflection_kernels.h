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

/// The largest component of a gradient's direction, as a look states it.
inline constexpr float kMostSlope = 32767;

/// A light that comes from one direction everywhere, or from the camera.
struct Ray {
    bool fromCamera;    ///< then the vectors are those to the camera
    glm::vec3 toLight;  ///< of length 1
    glm::vec3 half;  ///< half-way to the camera, of length 1; only where all see it from one side
    glm::vec3 diffuse;   ///< colour times strength times the share that is reflected evenly
    glm::vec3 specular;  ///< that is mirrored, likewise, in units of VoxelUnits for an alpha of 1

    bool operator==(const Ray&) const = default;
};

/// Heights (OwnLook) above a surface are in sizes of a voxel, which is the root of the sum of
/// squares of what its edges go along the normal: from kMostHeight on nothing of a voxel is seen,
/// and 0 is kMostDepth below.
inline constexpr float kMostHeight = 1.5;
inline constexpr float kMostDepth = 3;
/// Numbers of OwnLook::height that a size takes.
inline constexpr float kHeightSteps = OwnLook::kAll / (kMostHeight + kMostDepth);

/// What tells how much is seen of voxels by or below a surface.
struct CutVoxels {
    /// In the world, in any unit: from a voxel to the next along slice, u and v.
    std::array<glm::vec3, 3> steps;
    glm::vec3 perSlice;  ///< of what the product with a way in that unit is how many slices it goes
    glm::vec3 blur;      ///< LitScene's

    bool operator==(const CutVoxels&) const = default;
};

/// What voxels reflect (Shading).
struct Reflection {
    float ambient;
    float shininess;
    bool hasSpecular;
    std::vector<Ray> rays;
    /// Of what is solid, which gradients point out of; otherwise either side of one may face the
    /// camera.
    std::optional<CutVoxels> cut;
    bool fromEye;        ///< each voxel has its own way to the camera
    glm::vec3 toCamera;  ///< of length 1, unless it has

    bool operator==(const Reflection&) const = default;
};

/// What is lit.
struct WordToLight {
    const glm::vec4* colors;       ///< of classes, premultiplied
    const std::uint16_t* classes;  ///< [64]
    /// [64]: gradients in the world, of length kMostSlope times the share that is shaded
    const OwnLook* looks;
    const WaysToEye* ways;  ///< null unless `fromEye`
};

/// Returns the premultiplied colours that voxels reflect. The same bits at every SIMD level.
void reflect(const Reflection& reflection, const WordToLight& word, WordUnits& units);

}  // namespace deltasplat
