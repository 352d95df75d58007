// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/optics/shading.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// Light from infinitely far away: a lat-long picture of all directions. Columns are longitudes,
/// rows latitudes, as with Projection::kLatlong: in the environment's own space y is up, the
/// picture's middle lies towards -z, and +x a quarter of the picture to the right.
struct Environment {
    glm::ivec2 sizePixels{0};  ///< twice as wide as high
    std::vector<float>
        rgb;  ///< scene-linear radiance, finite and >= 0: `[height][width][3]`, rows top to bottom
    glm::dmat3 worldFromEnvironment{1.0};  ///< a rotation
};

/// Reads a lat-long picture: .exr, .hdr, .tif, .tiff, .png, .jpg or .jpeg, in colour or grey. Alpha
/// is ignored. Warns of whole numbers, decoded as sRGB, 0..1, and of values below 0, taken as 0.
/// @throw Error(kInput) if the file cannot be read, is not twice as wide as high, or has other
///        channels than R, G and B or one, a value that is not finite, or no light
Environment readEnvironment(const std::filesystem::path& file, const Listener& listener = {});

/// Cuts an environment into regions of one distant light (LightFrame::kWorld) each, so that lights
/// lie close to where light comes from: each has its region's irradiance and mean direction. Colour
/// 1 and strength 1 have the irradiance pi (Shading), so colours times strengths add up to the
/// radiance's integral over all directions, over pi: 4 for a radiance of 1. Deterministic.
/// @param count  of lights, >= 1
/// @return at most `count` lights, brightest first; fewer where more would not be closer (one
///        bright pixel is one light), none if all is black
/// @throw Error(kUsage) if the count is below 1, the size not twice as wide as high or not of the
///        values, or worldFromEnvironment no rotation; Error(kInput) for a light above kMostLight
std::vector<Light> cutIntoLights(const Environment& environment, int count);

}  // namespace deltasplat
