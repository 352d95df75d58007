// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"

namespace deltasplat {

/// Footprint weights for the kernels: repeated per channel, rows padded to whole vectors.
struct StampWeights {
    StampWeights(const Footprint& footprint, int sheetChannels);

    int channels;                       ///< of the sheet: 1 (opacity) or 4 (RGBA)
    int rows;                           ///< and pixels per row: footprints are square
    std::size_t rowLength;              ///< 32-bit integers a row
    std::vector<std::int32_t> weights;  ///< [rows][rowLength]
};

/// Stamped voxels of one slice of a block.
struct BlockStamps {
    std::uint64_t byColumn;        ///< bit 8 * v + u: voxel (u, v) is stamped; not zero
    const std::uint16_t* classes;  ///< [64], n = 8 * u + v
    std::uint16_t* shown;          ///< [64]: the previous slice's classes, for stampChanges
    std::int32_t*
        first;  ///< the first voxel's footprint in the sheet, `[row][pitch / channels][channels]`
};

/// Stamped voxels with colours of their own, in a sheet of four channels.
struct ColorStamps {
    std::uint64_t byColumn;
    const ClassTable::Color* colors;  ///< [64], n = 8 * u + v
    ClassTable::Color* shown;         ///< [64]: the previous slice's, for stampChanges
    std::int32_t* first;
};

struct StampPlaces {
    const std::uint32_t*
        inBlock;        ///< [64]: pixels from the first voxel's footprint to each voxel's
    std::size_t pitch;  ///< integers from one row of the sheet to the next
};

/// Adds a stamp per voxel of the masks, in its class's colour: sheet += colour * weight, in 32-bit
/// integers, so their order does not matter. Vectors add zeros behind a row's end.
/// @param colors  of the class table
void stampWhole(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                const StampWeights& weights, const StampPlaces& places);

/// Adds stamps of the change from a voxel's shown class, which is replaced, to its class.
void stampChanges(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                  const StampWeights& weights, const StampPlaces& places);

void stampWhole(std::span<const ColorStamps> blocks, const StampWeights& weights,
                const StampPlaces& places);
void stampChanges(std::span<const ColorStamps> blocks, const StampWeights& weights,
                  const StampPlaces& places);

}  // namespace deltasplat
