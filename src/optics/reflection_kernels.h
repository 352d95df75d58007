// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "optics/voxel_painter.h"
#include "optics/ways_to_eye.h"

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

/// What voxels reflect (Shading).
struct Reflection {
    float ambient;
    float shininess;
    bool hasSpecular;
    std::vector<Ray> rays;
    /// Whether gradients point out of what is solid: of those that face away from the camera
    /// nothing is seen but what the outline shares with them. Otherwise either side of one may face
    /// the camera.
    bool isSolid;
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
