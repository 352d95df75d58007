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

/// Footprint weights laid out for the kernels: each repeated for all channels, rows padded with
/// zeros to whole vectors.
struct StampWeights {
    StampWeights(const Footprint& footprint, int sheetChannels);

    int channels;                       ///< of the sheet: 1 (opacity) or 4 (RGBA)
    int rows;                           ///< and pixels a row: footprints are square
    std::size_t rowLength;              ///< 32-bit integers a row
    std::vector<std::int32_t> weights;  ///< [rows][rowLength]
};

/// The voxels of one slice of a block that are stamped.
struct BlockStamps {
    std::uint64_t byColumn;        ///< bit 8 * v + u: voxel (u, v) is stamped; not zero
    const std::uint16_t* classes;  ///< [64], n = 8 * u + v
    std::uint16_t* shown;          ///< [64]: the classes of the slice before, for stampChanges
    std::int32_t*
        first;  ///< sheet: of the first voxel's footprint, `[row][pitch / channels][channels]`
};

/// The same of voxels that have colours of their own, of a sheet of four channels.
struct ColorStamps {
    std::uint64_t byColumn;
    const ClassTable::Color* colors;  ///< [64], n = 8 * u + v
    ClassTable::Color* shown;         ///< [64]: those of the slice before, for stampChanges
    std::int32_t* first;
};

/// Where stamps go.
struct StampPlaces {
    const std::uint32_t* inBlock;  ///< [64]: pixels from the first voxel's footprint to each
    std::size_t pitch;             ///< integers from one row of the sheet to the next
};

/// Adds a stamp for every voxel of the blocks' masks, in the colour of its class: sheet += colour *
/// weight, in 32-bit integers, so that the order of stamps does not matter. Vectors may reach over
/// a row's end, where they add zeros.
/// @param colors  of the class table
void stampWhole(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                const StampWeights& weights, const StampPlaces& places);

/// Adds a stamp for every voxel of the blocks' masks, in the difference between the colour of its
/// class and that of the class it showed before, which is replaced.
void stampChanges(std::span<const BlockStamps> blocks, const ClassTable::Color* colors,
                  const StampWeights& weights, const StampPlaces& places);

/// The same of voxels' own colours.
void stampWhole(std::span<const ColorStamps> blocks, const StampWeights& weights,
                const StampPlaces& places);
void stampChanges(std::span<const ColorStamps> blocks, const StampWeights& weights,
                  const StampPlaces& places);

}  // namespace deltasplat
