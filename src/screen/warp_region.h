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

/// Resamples the base plane of an eye's region into the pixels whose lines of sight belong to its
/// slice axis, with a filter widened for coarse pictures. Deterministic; multi-threaded.
/// @param raster  pixels of the plane
/// @param view    of the volume's own voxels
/// @param thin    of the divided voxels, for the plane
/// @return how much this can enlarge a difference of rasters at most
double warpRegion(const Raster& raster, const Camera& camera, const Factorization& view,
                  const Factorization& thin, const BasePlane& plane, WarpFilter filter,
                  const PicturePart& part);

/// Returns a box of plane pixels that includes all that `pixels` read.
PlaneBox readByRegion(const Camera& camera, const Factorization& view, const Factorization& thin,
                      const BasePlane& plane, const PixelBox& pixels);

/// Knows which squares of a raster are not zero.
class RasterTiles {
  public:
    /// Multi-threaded.
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

/// Samples a raster near its edge; the outside is transparent.
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

/// Returns a fixed-point position.
FixedPosition fixedPosition(glm::dvec2 position);
/// The same for a position from Raster::origin(); the result counts from the first pixel.
FixedPosition fixedPosition(glm::dvec2 position, const Raster& raster);

/// Returns a filter of stretch 1, made once.
const FilterTable& narrowestFilter(WarpFilter filter);

}  // namespace deltasplat
