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

/// The weights of a footprint that reaches no farther than the voxels next to a sheet pixel, as the
/// kernel takes them: a sheet pixel is the sum over its nearest 3x3 voxels, two rows at a time.
struct TileWeights {
    /// For one vector of pixels, by the column of the voxel (before, here, behind): low 16 bits the
    /// weight of a row of voxels, high 16 bits that of the row behind it.
    using Columns = std::array<std::array<std::int32_t, 16>, 3>;
    /// What a row of pixels takes from the pair of rows of voxels that it belongs to, and from
    /// those before and behind it.
    struct Row {
        Columns before{};
        Columns here{};
        Columns behind{};
    };

    /// Whether a footprint is small enough: at most 3x3 pixels at one sheet pixel a voxel, or 5x5
    /// at two.
    static bool fits(const Footprint& footprint);
    /// @param footprint  one that fits
    TileWeights(const Footprint& footprint, int sheetChannels);

    int resolution;             ///< 1 or 2 sheet pixels a voxel
    int channels;               ///< of plane and sheet: 1 or 4
    std::array<Row, 4> rows{};  ///< of a pair's 2 * resolution rows of pixels
};

/// Where a row of tiles lies.
struct TileRow {
    std::int32_t* sheet;     ///< the first tile, `[row][pitch]`
    std::size_t sheetPitch;  ///< 32-bit integers from one row to the next
};

/// What its pixels are summed from.
struct PlaneRow {
    const std::int16_t* first;  ///< colours of the first tile's voxels, `[row][pitch]`
    std::size_t pitch;          ///< 16-bit integers from one row to the next
};

/// Colours of a row of tiles' voxels that lie two rows together, number by number: one of an even
/// row, then that of the row behind it. Rows of tiles begin with a pair.
struct PairedRow {
    const std::int16_t* first = nullptr;  ///< of the first tile's voxels, `[pair of rows][pitch]`
    std::size_t pitch = 0;                ///< 16-bit integers from one pair to the next
};

/// What low digits are summed from, where they go with high ones.
struct LowRow {
    PairedRow plane;  ///< their colours
    /// Of each tile, rows that may have any, and after it those that do; empty if there are none.
    std::span<std::uint8_t> rows;
};

/// Splats rows of tiles whole: makes each touched row the sum of colour times weight of all voxels
/// that reach it, which lie in it and next to it: the very integers that stamps add up to. Low
/// digits are added as addLowDigits() adds them.
/// @param touched  a byte for each tile, bit y for its row y, and zeros up to a multiple of eight
/// @param full     likewise; says of touched rows whether they are not all zero
void splatTiles(const TileWeights& weights, const PairedRow& plane, const LowRow& low,
                const TileRow& row, std::span<const std::uint8_t> touched,
                std::span<std::uint8_t> full);

/// The digits that a row of tiles is put together from, `[row][pitch]`.
struct DigitRows {
    const std::int32_t* high;
    const std::int32_t* low;
    std::size_t pitch;  ///< as of the row of tiles
};

/// Adds low digits to high ones: high + low / 2^15, rounded, in rows of tiles.
/// @param rows   a byte for each tile, as `touched` of splatTiles: which to make
/// @param sheet  where they go; may be `digits.high`
/// @param full   likewise; bits are set where a row is not all zero, and left as they are elsewhere
void addLowDigits(const DigitRows& digits, int channels, std::span<const std::uint8_t> rows,
                  std::int32_t* sheet, std::span<std::uint8_t> full);

/// Finds out of touched rows whether they are not all zero.
/// @param touched,full  as for splatTiles
void findFullRows(const TileRow& row, int channels, std::span<const std::uint8_t> touched,
                  std::span<std::uint8_t> full);

}  // namespace deltasplat
