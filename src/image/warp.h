// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// A float raster that lies somewhere on an integer lattice: `[size.y][size.x][channels]`,
/// transparent outside.
struct Raster {
    glm::ivec2 min{0};  ///< lattice position of the first pixel's centre
    glm::ivec2 size{0};
    const float* values = nullptr;
    int channels = 4;  ///< 4: premultiplied RGBA; 1: opacity, or another value
    /// The colour that opacity 1 has, if opacity is all there is.
    glm::vec3 color{1.0f};
    /// What a value that stands alone is clamped to: where it is no opacity, the raster's own range
    /// and 0.
    glm::vec2 range{0.0f, 1.0f};
    /// [size.y], or empty: columns [x, y) outside of which a row is zero.
    std::span<const glm::ivec2> spans{};
};

/// Resamples a raster under an affine map with a Catmull-Rom filter, widened where the picture is
/// coarser than the raster. Colours are clamped to be not negative, alpha to 0..1 and values that
/// stand alone to their range: the filter's lobes may leave it. Deterministic; multi-threaded.
/// @param rasterFromPixel  continuous picture coordinates (pixel centres at half-integers) to
/// lattice positions
void warp(const Raster& raster, const glm::dmat3& rasterFromPixel, Image& picture);

/// Returns the most that `warp` under the same map can enlarge a difference of rasters.
double warpGain(const glm::dmat3& rasterFromPixel);

}  // namespace deltasplat
