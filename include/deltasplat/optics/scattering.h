// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// How fog scatters light. The transfer function's medium dims light on its way from each lamp, and
/// sends some of it to the camera. A voxel shines with
///
///     c albedo (ambient + sum over lights, and over i = 0..octaves, of
///               min(c albedo, 1)^i pi I 2^-i p_i(cos) exp(-depth 2^-i))
///
/// where c is the colour (the transfer function's, times that of colour grids), I a light's colour
/// times its strength, depth the extinction that the light has come through (Optics, scaled), and
/// cos that of the angle by which light turns towards the camera. i = 0 is light scattered once.
/// Larger i stand for light scattered more often: less of it, from farther, in more directions
/// (Wrenninge, Kulla, Lundqvist, Oz: The Great and Volumetric, 2013).
///
/// p, Henyey and Greenstein's (1941) with two lobes, has the integral 1 over all directions:
///
///     p_i = (1 - backShare) hg(2^-i anisotropy) + backShare hg(2^-i backAnisotropy)
///     hg(g) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^1.5)
///
/// A light of strength 1 has irradiance pi, as with Shading, where a white surface facing it has a
/// radiance of 1. White fog that scatters evenly has a quarter of that.
///
/// A point light's I is divided by R^2, in world units. R is the distance of the voxel's centre
/// from the light, but at least the light's radius and 0.358 d, d^3 being a voxel's volume: 1 / R^2
/// is then the mean over a ball of that volume around the light. Nearer light comes from more and
/// more sides: p_i goes over to 1 / (4 pi) in the middle.
struct Scattering {
    /// Share of the light that is scattered, not swallowed: 0..1 each.
    glm::dvec3 albedo{1.0};
    double anisotropy = 0;      ///< -0.99..0.99: < 0 backwards, 0 evenly, > 0 forwards
    double backAnisotropy = 0;  ///< of the second lobe, likewise
    double backShare = 0;       ///< share of the second lobe: 0..1
    int octaves = 0;            ///< 0..kMostOctaves
    glm::dvec3 ambient{0.0};    ///< radiance from everywhere, never dimmed, 0..kMostLight
    std::vector<Light> lights;  ///< of frame kWorld
};

inline constexpr int kMostOctaves = 8;
/// The largest anisotropy, either way.
inline constexpr double kMostAnisotropy = 0.99;

}  // namespace deltasplat
