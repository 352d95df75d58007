// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "deltasplat/splat/footprint.h"

namespace deltasplat {

/// Sheets are watched, and may be splatted, in squares of this many pixels.
inline constexpr int kTilePixels = 8;

/// The weights of a footprint of at most 3x3 pixels at one sheet pixel a voxel, as the kernel takes
/// them: a sheet pixel is the sum over its nine nearest voxels, two rows at a time.
struct TileWeights {
    /// Whether a footprint is small enough.
    static bool fits(const Footprint& footprint) {
        return footprint.resolution == 1 && footprint.width % 2 == 1 && footprint.width <= 3;
    }
    /// @param footprint  one that fits
    TileWeights(const Footprint& footprint, int sheetChannels);

    int channels;  ///< of plane and sheet: 1 or 4
    /// [x]: for the voxels at x - 1, the weight of the row before (low 16 bits) and of the row
    /// itself.
    std::array<std::int32_t, 3> firstRows{};
    std::array<std::int32_t, 3> lastRow{};  ///< [x]: likewise, of the row behind (low 16 bits)
};

/// Where a row of tiles lies.
struct TileRow {
    const std::int16_t* plane;  ///< colours of the first tile's voxels, `[row][planePitch]`
    std::size_t planePitch;     ///< 16-bit integers from one row to the next
    std::int32_t* sheet;        ///< the first tile, `[row][sheetPitch]`
    std::size_t sheetPitch;     ///< 32-bit integers from one row to the next
};

/// Splats rows of tiles whole: makes each touched row the sum of colour times weight of all voxels
/// that reach it, which lie in it and the pixels around it: the very integers that stamps add up
/// to.
/// @param touched  a byte for each tile, bit y for its row y; rows between touched ones are made
/// too
/// @param full     likewise; says of touched rows whether they are not all zero
void splatTiles(const TileWeights& weights, const TileRow& row,
                std::span<const std::uint8_t> touched, std::span<std::uint8_t> full);

}  // namespace deltasplat
