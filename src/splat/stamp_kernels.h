// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"

namespace deltasplat {

/// Stamps that wait to be added: colours in units of the class table, and where they go. Fixed
/// size, so that it stays in the first-level cache and nothing is allocated on the way.
struct StampList {
    static constexpr std::size_t kCapacity = 512;

    std::size_t count = 0;
    std::array<std::uint32_t, kCapacity> places;  ///< pixel of the footprint's corner
    alignas(64) std::array<std::array<std::int32_t, 4>, kCapacity> colors;  ///< RGBA
};

/// Footprint weights laid out for the kernels: each repeated for all channels, rows padded with
/// zeros to whole vectors.
struct StampWeights {
    StampWeights(const Footprint& footprint, int sheetChannels);

    int channels;                       ///< of the sheet: 1 (opacity) or 4 (RGBA)
    int rows;                           ///< and pixels a row: footprints are square
    std::size_t rowLength;              ///< 32-bit integers a row
    std::vector<std::int32_t> weights;  ///< [rows][rowLength]
};

/// The 64 voxels of one slice of a block, and where their stamps go.
struct BlockSlice {
    const std::uint16_t* classes;       ///< [64]
    std::uint64_t active;               ///< bit n: voxel n counts
    std::uint32_t place;                ///< of the first voxel's footprint
    const std::uint32_t* placeInBlock;  ///< [64]: of each voxel's footprint, from the first one's
};

/// Lists a stamp for every active voxel, in the colour of its class. The list must have room for
/// 64.
/// @param colors  of the class table
void listWhole(const BlockSlice& slice, const ClassTable::Color* colors, StampList& stamps);

/// Lists a stamp for every active voxel, in the difference between the colour of its class and that
/// of the class it showed before ([64]), which is replaced.
void listChanges(const BlockSlice& slice, const ClassTable::Color* colors, std::uint16_t* shown,
                 StampList& stamps);

/// Adds every stamp of the list to the sheet: sheet += colour * weight, in 32-bit integers, so that
/// the order of stamps does not matter. Empties the list.
/// @param sheet  `[row][pitch / channels][channels]`
/// @param pitch  integers from one row to the next
void addStamps(std::int32_t* sheet, std::size_t pitch, const StampWeights& weights,
               StampList& stamps);

/// Returns which of the rows of a tile that `rows` has bits for are not all zero, bit y for row y.
/// Rows are `pitch` integers apart.
std::uint8_t findFullRows(const std::int32_t* tile, std::size_t pitch, int channels,
                          std::uint8_t rows);

}  // namespace deltasplat
