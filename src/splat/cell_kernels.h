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

/// The weights of a footprint that reaches farther than TileWeights, at one to four sheet pixels a
/// voxel, as the kernel takes them. A voxel's cell is the r x r pixels from its own one on; what is
/// seen in a cell comes from *taps* voxels along rows and as many along columns: before() of them
/// before its own, and the rest from its own on.
struct CellWeights {
    static constexpr int kMostTaps = 7;
    /// Weights of pixels in a row of a cell, from one of them on into the next cell,
    /// `[pixels][channels]`: low 16 bits that of a voxel, high 16 bits that of the one in the row
    /// behind it.
    struct alignas(64) Line : std::array<std::int32_t, 16> {};

    /// Whether a footprint reaches no farther: over 7 voxels at one pixel a voxel, where its width
    /// is odd, or 6 at two to four.
    static bool fits(const Footprint& footprint);
    /// @param footprint  one that fits
    CellWeights(const Footprint& footprint, int sheetChannels);

    int before() const { return (taps - 1) / 2; }
    /// Rows of voxels are taken two and two; of an odd number the last has no weight.
    int rowPairs() const { return (taps + 1) / 2; }
    /// Returns those of a cell's row `y`, from its pixel `x` on: `[pair of rows][tap]`.
    const Line* from(int x, int y) const {
        return &lines[std::size_t(y * resolution + x) * rowPairs() * taps];
    }

    int resolution;  ///< r
    int channels;    ///< of plane and sheet: 1 or 4
    int taps;        ///< 5 or 7 at one pixel a voxel, 4 to 6 at more
    std::vector<Line> lines;
};

/// The colours of voxels, and where their cells lie.
struct CellPlane {
    const std::int16_t* voxel;  ///< one of them, `[row][pitch]`; there are others all around it
    std::size_t pitch;          ///< 16-bit integers from one row to the next
    glm::ivec2 pixel;  ///< the first pixel of the first tile, counted from that voxel's own pixel
};

/// As splatTiles, for footprints of CellWeights; without low digits, and rows between touched ones
/// are made too.
void splatCells(const CellWeights& weights, const CellPlane& plane, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);

}  // namespace deltasplat
