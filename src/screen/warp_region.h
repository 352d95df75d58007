// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/view/camera.h"
#include "screen/warp.h"
#include "screen/warp_kernels.h"
#include "view/base_plane.h"

namespace deltasplat {

/// Resamples the base plane of a region of a picture that is seen from an eye: writes those pixels
/// whose lines of sight belong to its slice axis, with a filter that is widened where the picture
/// is coarser than the plane. Deterministic; multi-threaded.
/// @param raster  pixels of the plane
/// @param view    of the volume's own voxels
/// @param thin    of what they are divided into, which the plane is of
/// @return the most by which it can enlarge a difference of rasters
double warpRegion(const Raster& raster, const Camera& camera, const Factorization& view,
                  const Factorization& thin, const BasePlane& plane, WarpFilter filter,
                  const PicturePart& part);

/// Returns the pixels of the plane that some of the picture's read, and a few around them.
PlaneBox readByRegion(const Camera& camera, const Factorization& view, const Factorization& thin,
                      const BasePlane& plane, const PixelBox& pixels);

/// Knows which squares of a raster hold anything but zeros.
class RasterTiles {
  public:
    /// Looks at all of it. Multi-threaded.
    explicit RasterTiles(const Raster& raster);

    /// Whether any pixel of [first, last], both inclusive, may not be zero.
    bool anyIn(glm::ivec2 first, glm::ivec2 last) const;

  private:
    static constexpr int kTile = 8;

    void findRow(const Raster& raster, int row);

    glm::ivec2 tiles_;
    int words_;
    std::vector<std::uint64_t> full_;  // [tile row][words_]
};

/// Samples a raster near its edge: what lies outside counts as transparent.
class EdgeSampler {
  public:
    EdgeSampler(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY)
        : raster_(raster), filterX_(filterX), filterY_(filterY) {}

    /// @param out  RGBA
    void sample(FixedPosition position, float* out) const;

  private:
    void sumColumn(glm::ivec2 first, const float* weightY, int begin, int end, float* column) const;
    const float* tapAt(glm::ivec2 p) const;
    void write(const float* sum, float* out) const;

    const Raster& raster_;
    const FilterTable& filterX_;
    const FilterTable& filterY_;
};

/// Returns a position as a fixed number.
FixedPosition fixedPosition(glm::dvec2 position);
/// The same of one that is counted from Raster::origin(), counted from the first pixel.
FixedPosition fixedPosition(glm::dvec2 position, const Raster& raster);

/// Returns a filter that is not widened; made once.
const FilterTable& narrowestFilter(WarpFilter filter);

}  // namespace deltasplat
