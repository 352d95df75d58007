// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/optics/shading.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// Light from everywhere, infinitely far away: a lat-long picture of what is seen in all
/// directions. Columns are longitudes, rows latitudes, as in a picture of Projection::kLatlong: in
/// the environment's own space y is up, the middle of the picture lies towards -z, and +x is a
/// quarter of the picture to the right of it.
struct Environment {
    glm::ivec2 sizePixels{0};              ///< twice as wide as high
    std::vector<float> rgb;                ///< radiance, scene-linear, finite and >= 0:
                                           ///< `[height][width][3]`, rows top to bottom
    glm::dmat3 worldFromEnvironment{1.0};  ///< a rotation
};

/// Reads a lat-long picture: .exr, .hdr, .tif, .tiff, .png, .jpg or .jpeg, of colours or greys.
/// Alpha is ignored. Whole numbers are decoded as sRGB, 0..1; they and values below 0, which count
/// as 0, are warned of.
/// @throw Error(kInput) if the file cannot be read, or is not twice as wide as high, has other
///        channels than R, G and B or one, a value that is not finite, or no light
Environment readEnvironment(const std::filesystem::path& file, const Listener& listener = {});

/// Cuts an environment into regions with one distant light (LightFrame::kWorld) each, so that
/// their lights lie close to where the light comes from: a region's light has all of its
/// irradiance, and its mean direction. A light of colour 1 and strength 1 has the irradiance pi
/// (Shading), so that colours times strengths add up to the integral of the radiance over all
/// directions, divided by pi: 4 for a radiance of 1 everywhere. Deterministic.
/// @param count  of lights, >= 1
/// @return at most `count` lights, the brightest first; fewer only where more would not come closer
///         (one bright pixel is one light), none if all is black
/// @throw Error(kUsage) if the count is below 1, the size is not twice as wide as high or not that
///        of the values, or worldFromEnvironment is no rotation; Error(kInput) if a light would be
///        brighter than kMostLight
std::vector<Light> cutIntoLights(const Environment& environment, int count);

}  // namespace deltasplat
