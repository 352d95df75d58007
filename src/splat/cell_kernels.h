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

/// The weights of a footprint at three or four sheet pixels a voxel, as the kernel takes them. A
/// voxel's cell is the r x r pixels from its own one on; what is seen in a cell comes from 4x4
/// voxels: along rows and columns the one before it, its own, and two behind.
struct CellWeights {
    static constexpr int kTaps = 4;
    /// Weights of pixels in a row of a cell, from one of them on into the next cell,
    /// `[pixels][channels]`: low 16 bits that of a voxel, high 16 bits that of the one in the row
    /// behind it.
    struct alignas(64) Line : std::array<std::int32_t, 16> {};
    /// By where the voxel is: rows before the cell's own and that one, then those behind; in each
    /// the kTaps columns.
    using Lines = std::array<Line, 2 * kTaps>;

    /// Whether a footprint reaches no farther, and has three or four pixels a voxel.
    static bool fits(const Footprint& footprint);
    /// @param footprint  one that fits
    CellWeights(const Footprint& footprint, int sheetChannels);

    /// Returns those of a cell's row `y`, from its pixel `x` on.
    const Lines& from(int x, int y) const { return lines[std::size_t(y) * resolution + x]; }

    int resolution;  ///< r
    int channels;    ///< of plane and sheet: 1 or 4
    std::vector<Lines> lines;
};

/// The colours of voxels, and where their cells lie.
struct CellPlane {
    const std::int16_t* voxel;  ///< one of them, `[row][pitch]`; there are others all around it
    std::size_t pitch;          ///< 16-bit integers from one row to the next
    glm::ivec2 pixel;  ///< the first pixel of the first tile, counted from that voxel's own pixel
};

/// As splatTiles, for footprints of CellWeights.
void splatCells(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);

}  // namespace deltasplat
