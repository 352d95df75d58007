// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace deltasplat {

/// What a light's direction is relative to.
enum class LightFrame {
    kHead,  ///< the viewer: light travels along each line of sight
    kView,  ///< the camera: x to its right, y up, z towards the camera
    kWorld,
};

/// A point light, or a distant light, which shines in one direction everywhere.
struct Light {
    LightFrame frame = LightFrame::kHead;
    /// Direction of travel, any length but 0; no effect for kHead and point lights.
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 color{1.0};  ///< scene-linear, each 0..kMostLight
    double strength = 1;    ///< 0..kMostLight; multiplies the colour
    /// Position of a point light, which shines evenly to all sides: r world units away it is as
    /// strong as a distant light of strength / r^2. Each number within
    /// -kFarthestLight..kFarthestLight; only kWorld and fog (Scattering). Empty: a distant light.
    std::optional<glm::dvec3> positionWorld = std::nullopt;
    /// Of a point light, 0..kFarthestLight: its strength stops growing at this distance.
    double radiusWorld = 0;
};

/// Largest colour, strength or share of a light.
inline constexpr double kMostLight = 1e6;
/// Largest coordinate of a light.
inline constexpr double kFarthestLight = 1e30;

/// How surfaces reflect light (Blinn 1977): a voxel of colour c and unit normal n shines with
///
///     c (ambient + diffuse * sum of I max(0, n l)) + specular * sum of I max(0, n h)^shininess
///
/// where l is the way towards a light, I its colour times its strength, and h half-way between l
/// and the way to the camera. The side of n that faces the camera counts.
///
/// n is the volume's gradient, by central differences in the world. A small gradient is noise: with
/// g its length times the smallest voxel size, and b the `noise`, only a share of g^2 / (g^2 + b^2)
/// is shaded this way. The rest is lit as the mean of surfaces in all directions: I (1 + l v) / 4
/// in place of I max(0, n l), v being the way to the camera, and no specular light.
struct Shading {
    double ambient = 0.15;  ///< 0..kMostLight, as the next two
    double diffuse = 0.85;
    double specular = 0.15;
    double shininess = 20;  ///< larger: smaller highlights
    std::vector<Light> lights{Light{}};
    /// Data units, > 0; empty: a hundredth of the bulk of the values (bulkRange, default_ramp.h),
    /// which differs between the volumes of a sequence.
    std::optional<double> noise = std::nullopt;
};

}  // namespace deltasplat
