// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace deltasplat {

/// What a light's direction is relative to.
enum class LightFrame {
    kHead,   ///< it shines from where the picture is seen from, along each line of sight
    kView,   ///< the camera: x to its right, y up, z towards it from what it sees
    kWorld,  ///< the world
};

/// A light from so far away that it shines in one direction everywhere, or a point light.
struct Light {
    LightFrame frame = LightFrame::kHead;
    /// The way it travels, of any length but 0; of no effect: of kHead and of point lights.
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 color{1.0};  ///< scene-linear, each 0..kMostLight
    double strength = 1;    ///< 0..kMostLight; multiplies the colour
    /// Where a point light stands, which shines evenly to all sides: r world units away it is as
    /// strong as light from far away of strength / r^2. Each number within
    /// -kFarthestLight..kFarthestLight; kWorld, and for fog alone (Scattering). Empty: it comes
    /// from far away.
    std::optional<glm::dvec3> positionWorld = std::nullopt;
    /// Of a point light, 0..kFarthestLight: nearer than that it grows no stronger.
    double radiusWorld = 0;
};

/// The largest number that a light's colour or strength, or a share of it, may be.
inline constexpr double kMostLight = 1e6;
/// The largest number that says where a light stands.
inline constexpr double kFarthestLight = 1e30;

/// How surfaces reflect light (Blinn 1977): a voxel of colour c, whose value changes in direction n
/// of length 1, shines with
///
///     c (ambient + diffuse * sum of I max(0, n l)) + specular * sum of I max(0, n h)^shininess
///
/// where of each light l is the way towards it, I its colour times its strength, and h half-way
/// between l and the way to the camera. Of the two sides of n the one counts that faces the camera.
///
/// n is the gradient of the volume, by central differences in the world. Where there is little of
/// it, n is noise: with g its length times the smallest voxel size, and b the `noise`, a share of
/// g^2 / (g^2 + b^2) is shaded so. The rest is lit as surfaces of all directions are on average: I
/// (1 + l v) / 4 in place of I max(0, n l), v being the way to the camera, and nothing specular.
struct Shading {
    double ambient = 0.15;  ///< 0..kMostLight, as the others
    double diffuse = 0.85;
    double specular = 0.15;
    double shininess = 20;  ///< the larger, the smaller highlights are
    std::vector<Light> lights{Light{}};
    /// Data units, above 0; empty: a hundredth of where most values lie (bulkRange,
    /// default_ramp.h), which changes from one volume of a sequence to the next.
    std::optional<double> noise = std::nullopt;
};

}  // namespace deltasplat
