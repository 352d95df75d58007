// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "deltasplat/splat/footprint.h"
#include "splat/tile_kernels.h"

namespace deltasplat {

/// Kernel weights of a footprint that reaches farther than TileWeights, at one to four sheet pixels
/// per voxel. A voxel's cell is the r x r pixels from its own pixel on. A cell sums up *taps* x
/// taps voxels; along rows and columns, before() of them lie before its own voxel.
struct CellWeights {
    static constexpr int kMostTaps = 7;
    /// Weights of pixels in a row of a cell and on into the next cell, `[pixels][channels]`: low 16
    /// bits for a voxel, high 16 bits for the voxel in the row behind it.
    struct alignas(64) Line : std::array<std::int32_t, 16> {};

    /// At most 7 voxels at one pixel per voxel and an odd width, or 6 at two to four.
    static bool fits(const Footprint& footprint);
    /// @param footprint  one that fits
    CellWeights(const Footprint& footprint, int sheetChannels);

    int before() const { return (taps - 1) / 2; }
    /// Rows of voxels are taken in pairs; the last row of an odd number has no weight.
    int rowPairs() const { return (taps + 1) / 2; }
    /// Returns the lines of a cell's row `y`, from its pixel `x` on: `[pair of rows][tap]`.
    const Line* from(int x, int y) const {
        return &lines[std::size_t(y * resolution + x) * rowPairs() * taps];
    }

    int resolution;  ///< r
    int channels;    ///< of plane and sheet: 1 or 4
    int taps;        ///< 5 or 7 at one pixel per voxel, 4 to 6 at more
    std::vector<Line> lines;
};

struct CellPlane {
    const std::int16_t* voxel;  ///< a voxel with others all around, `[row][pitch]`
    std::size_t pitch;          ///< 16-bit integers from one row to the next
    glm::ivec2 pixel;  ///< the first tile's first pixel, counted from that voxel's own pixel
};

/// Like splatTiles, for CellWeights, without low digits; also makes the rows between touched ones.
void splatCells(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);

}  // namespace deltasplat
