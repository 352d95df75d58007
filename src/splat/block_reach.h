// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/bits.h"

namespace deltasplat {

/// Which rows of which tiles the footprints of a block's 8x8 voxels reach. Tiles are counted from
/// the first that any of them reaches.
class BlockReach {
  public:
    /// @param resolution   sheet pixels a voxel
    /// @param reachPixels  as Footprint::reach
    /// @param width        of the footprint, in pixels
    BlockReach(int resolution, int reachPixels, int width);

    /// The first tile reached, counted from the one in which the block's first voxel lies; <= 0.
    int firstTile() const { return firstTile_; }
    /// Tiles reached along a row, and along a column.
    int tiles() const { return tiles_; }

    /// Returns the rows of voxels, bit u, in which any of `voxels` (bit 8 * u + v) reaches a column
    /// of tiles.
    std::uint8_t rowsReaching(int tileColumn, std::uint64_t voxels) const {
        return rowsWithAny(voxels & columns_[tileColumn]);
    }
    /// Returns the pixel rows that footprints reach from rows of voxels, of the eight rows of tiles
    /// from 8 * `group` on: bit y of byte i for row y of the tile in the i-th of them.
    std::uint64_t pixelRows(int group, std::uint8_t voxelRows) const {
        return pixelRows_[group][voxelRows];
    }

  private:
    int firstTile_;
    int tiles_;
    std::vector<std::uint64_t> columns_;  // [tile column]: the voxels that reach it
    // [tile row / 8][rows of voxels]
    std::vector<std::array<std::uint64_t, 256>> pixelRows_;
};

}  // namespace deltasplat
