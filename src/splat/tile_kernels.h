// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "deltasplat/splat/footprint.h"

namespace deltasplat {

/// Side in pixels of the squares in which sheets are tracked and splatted.
inline constexpr int kTilePixels = 8;

/// Kernel weights of a footprint that reaches only voxels next to a sheet pixel: a pixel is the sum
/// over its nearest 3x3 voxels, two rows at a time.
struct TileWeights {
    /// For one vector of pixels, by the voxel's column (before, here, behind): low 16 bits the
    /// weight of a row of voxels, high 16 bits that of the row behind it.
    using Columns = std::array<std::array<std::int32_t, 16>, 3>;
    /// Weights of a row of pixels for its own pair of voxel rows, and those before and behind.
    struct Row {
        Columns before{};
        Columns here{};
        Columns behind{};
    };

    /// Whether a footprint has at most 3x3 pixels at one sheet pixel per voxel, or 5x5 at two.
    static bool fits(const Footprint& footprint);
    /// @param footprint  one that fits
    TileWeights(const Footprint& footprint, int sheetChannels);

    int resolution;             ///< 1 or 2 sheet pixels per voxel
    int channels;               ///< of plane and sheet: 1 or 4
    std::array<Row, 4> rows{};  ///< of a pair's 2 * resolution rows of pixels
};

struct TileRow {
    std::int32_t* sheet;     ///< the first tile, `[row][pitch]`
    std::size_t sheetPitch;  ///< 32-bit integers from one row to the next
};

/// Colours that a row of tiles is summed from.
struct PlaneRow {
    const std::int16_t* first;  ///< colours of the first tile's voxels, `[row][pitch]`
    std::size_t pitch;          ///< 16-bit integers from one row to the next
};

/// Colours of a row of tiles' voxels, pairs of rows interleaved: a number of an even row, then that
/// of the row behind. Rows of tiles begin with a pair.
struct PairedRow {
    const std::int16_t* first = nullptr;  ///< of the first tile's voxels, `[pair of rows][pitch]`
    std::size_t pitch = 0;                ///< 16-bit integers from one pair to the next
};

/// Low digits that are summed along with high ones.
struct LowRow {
    PairedRow plane;
    /// Per tile, rows that may have low digits; on return rows that do. Empty: none.
    std::span<std::uint8_t> rows;
};

/// Splats rows of tiles whole: a touched row becomes the sum of colour times weight of all voxels
/// that reach it: the integers of stamps. Low digits are added as in addLowDigits().
/// @param touched  a byte per tile, bit y for its row y, and zeros up to a multiple of eight
/// @param full     likewise; set to whether touched rows are not all zero
void splatTiles(const TileWeights& weights, const PairedRow& plane, const LowRow& low,
                const TileRow& row, std::span<const std::uint8_t> touched,
                std::span<std::uint8_t> full);

/// Digits that add up to a row of tiles, `[row][pitch]`.
struct DigitRows {
    const std::int32_t* high;
    const std::int32_t* low;
    std::size_t pitch;  ///< as of the row of tiles
};

/// Adds low digits to high ones: high + low / 2^15, rounded, in rows of tiles.
/// @param rows   to make: a byte per tile, as `touched` of splatTiles
/// @param sheet  result; may be `digits.high`
/// @param full   likewise; rows that are not all zero are set, others left as they are
void addLowDigits(const DigitRows& digits, int channels, std::span<const std::uint8_t> rows,
                  std::int32_t* sheet, std::span<std::uint8_t> full);

/// Finds touched rows that are not all zero.
/// @param touched,full  as for splatTiles
void findFullRows(const TileRow& row, int channels, std::span<const std::uint8_t> touched,
                  std::span<std::uint8_t> full);

}  // namespace deltasplat
