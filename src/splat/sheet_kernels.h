// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "deltasplat/splat/footprint.h"

namespace deltasplat {

/// Sheets are watched in squares of this many pixels.
inline constexpr int kTilePixels = 8;

/// The sheet pixels reach at most this many past a stamp's last one when a vector is wider than
/// what is left.
inline constexpr int kMaxVectorPixels = 2;

/// Stamps that wait to be added: colours in units of the class table, and where they go. Fixed
/// size, so that it stays in the first-level cache and nothing is allocated on the way.
struct StampList {
    static constexpr std::size_t kCapacity = 512;

    std::size_t count = 0;
    std::array<std::uint32_t, kCapacity> places;  ///< pixel of the footprint's corner
    alignas(64) std::array<std::array<std::int32_t, 4>, kCapacity> colors;  ///< RGBA
};

/// Footprint weights laid out for the kernels: each repeated for the four channels, rows padded
/// with zeros to whole vectors.
struct StampWeights {
    explicit StampWeights(const Footprint& footprint);

    int rows;               ///< and pixels a row: footprints are square
    std::size_t rowLength;  ///< 32-bit integers a row, a multiple of 4 * kMaxVectorPixels
    std::vector<std::int32_t> weights;  ///< [rows][rowLength]
};

/// The 64 voxels of one slice of a leaf, and where their stamps go.
struct LeafSlice {
    const std::int32_t* values;         ///< [64]: slots, or changes of slots
    std::uint64_t active;               ///< bit n: voxel n counts
    std::uint32_t place;                ///< of the first voxel's footprint
    const std::uint32_t* placeInBlock;  ///< [64]: of each voxel's footprint, from the first one's
};

/// Lists a stamp for every active voxel, in the colour of its slot. The list must have room for 64.
/// @param entries  the class table, [kSlotCount]
void listWhole(const LeafSlice& slice, const std::array<std::uint16_t, 4>* entries,
               StampList& stamps);

/// Adds the changes to `slots` ([64]), and lists a stamp in the change of colour for every active
/// voxel that has one.
void listChanges(const LeafSlice& slice, const std::array<std::uint16_t, 4>* entries,
                 std::int32_t* slots, StampList& stamps);

/// Adds every stamp of the list to the sheet: sheet += colour * weight, in 32-bit integers, so that
/// the order of stamps does not matter. Empties the list.
/// @param sheet         int32 RGBA `[row][pitchPixels][4]`
void addStamps(std::int32_t* sheet, std::size_t pitchPixels, const StampWeights& weights,
               StampList& stamps);

/// Returns whether a tile of 8x8 RGBA pixels is all zero; rows are `pitch` integers apart.
bool isTileZero(const std::int32_t* tile, std::size_t pitch);

/// Sets a tile of 8x8 RGBA pixels to zero.
void clearTile(std::int32_t* tile, std::size_t pitch);

}  // namespace deltasplat
