// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <span>

#include "deltasplat/image/image.h"
#include "screen/filter_table.h"

namespace deltasplat {

/// A float raster on an integer lattice: `[size.y][size.x][channels]`, transparent outside.
struct Raster {
    glm::ivec2 min{0};  ///< lattice position of the first pixel's centre
    glm::ivec2 size{0};
    const float* values = nullptr;
    int channels = 4;  ///< 4: premultiplied RGBA; 1: opacity, or another value
    /// The colour of opacity 1, if channels is 1.
    glm::vec3 color{1.0f};
    /// [size.y], or empty: columns [x, y) outside of which a row is zero.
    std::span<const glm::ivec2> spans{};

    /// Place and size of the larger raster of which this is a part, if the part has all that is
    /// read. Positions are rounded as on the larger raster. Size 0: there is none.
    glm::ivec2 wholeMin{0};
    glm::ivec2 wholeSize{0};

    glm::ivec2 origin() const { return wholeSize.x > 0 ? wholeMin : min; }
    glm::ivec2 extent() const { return wholeSize.x > 0 ? wholeSize : size; }

    glm::ivec2 span(int i) const {
        return spans.empty() ? glm::ivec2(0, size.x) : spans[std::size_t(i)];
    }
    const float* row(int i) const { return values + std::size_t(channels) * size.x * i; }
};

/// The pixels of `image`, from `first` on, in a picture of `size`; each is written independently.
struct PicturePart {
    Image& image;
    glm::ivec2 first;
    glm::ivec2 size;

    explicit PicturePart(Image& whole) : image(whole), first(0), size(whole.size) {}
    PicturePart(Image& part, glm::ivec2 firstPixel, glm::ivec2 sizePixels)
        : image(part), first(firstPixel), size(sizePixels) {}
    glm::ivec2 last() const { return first + image.size; }
    /// Takes coordinates of the whole picture.
    float* pixel(int x, int y) const { return image.pixel(x - first.x, y - first.y); }
};

/// Resamples a raster under an affine map into every pixel of a part, with a filter that widens
/// where the picture is coarser than the raster. No value leaves the range of its neighbours,
/// including the zeros outside the raster. Deterministic; multi-threaded.
/// @param raster  within 2^30 of lattice point 0
/// @param rasterFromPixel  from picture coordinates (pixel centres at half-integers) to the lattice
/// @param memory  for halved rasters, if the picture is much coarser
/// @return how much this can enlarge a difference of rasters at most
double warp(const Raster& raster, const glm::dmat3& rasterFromPixel, WarpFilter filter,
            const PicturePart& part,
            std::pmr::memory_resource& memory = *std::pmr::get_default_resource());
inline double warp(const Raster& raster, const glm::dmat3& rasterFromPixel, WarpFilter filter,
                   Image& picture) {
    return warp(raster, rasterFromPixel, filter, PicturePart(picture));
}

}  // namespace deltasplat
