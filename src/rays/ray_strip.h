// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "rays/ray_volume.h"

namespace deltasplat {

/// A word for each slice of a block: bit 8 * u + v is set where the voxel is active.
using ActiveWords = std::array<std::uint64_t, 8>;

/// The values of a few rows of blocks in eight slices, and a border of what is empty around the
/// volume. Made once, to be filled for one layer of blocks after the other; not thread-safe.
///
/// Blocks are counted from the volume's first, rows along u and columns along v; voxel (v, u) of
/// the strip is the first of block (v / 8, u / 8).
class RayStrip {
  public:
    /// What of a block, or of the four blocks that a cell reads, is active.
    enum Fill : std::uint8_t { kNone = 0, kSome = 1, kAll = 2 };

    /// @param firstBlock  (v, u) of the volume's first block
    /// @param blocks      how many there are along (v, u)
    /// @param rows        the most block rows that it will hold, those of the border included
    RayStrip(const RayVolume& volume, RayRule rule, glm::ivec2 firstBlock, glm::ivec2 blocks,
             int rows);

    /// Reads rows [firstRow, lastRow], both inclusive, -1 to the number of blocks: the border.
    /// Blocks beside blocks with voxels are made empty, so that they can be read; what lies further
    /// off is not defined. Returns whether there is any voxel.
    bool read(int layer, int firstRow, int lastRow);

    /// What of a block is active, in the rows that were read; column -1 to the number of blocks.
    Fill fill(int row, int column) const { return fills_[at(row, column)]; }
    /// The values of a row of voxels, at column 0 of the volume; the border is 8 voxels wide.
    const float* values(int slice, int voxelRow) const {
        return &values_[line(slice, voxelRow) * pitch() + 8];
    }
    /// Which of them are active: a byte for each block, bit i for voxel i. Where the largest is
    /// kept.
    const std::uint8_t* active(int slice, int voxelRow) const {
        return &active_[line(slice, voxelRow) * columns_ + 1];
    }

    /// What all strips of this size take.
    static double bytes(glm::ivec2 blocks, int rows) {
        return 8.0 * 8 * rows * (sizeof(float) * 8 + 1) * (blocks.x + 2);
    }

  private:
    std::size_t at(int row, int column) const {
        return std::size_t(row - firstRow_) * columns_ + std::size_t(column + 1);
    }
    std::size_t voxelRows() const { return 8 * rows_; }
    std::size_t pitch() const { return 8 * columns_; }
    // Rows of voxels before one, those of other slices included.
    std::size_t line(int slice, int voxelRow) const {
        return std::size_t(slice) * voxelRows() + std::size_t(voxelRow - 8 * firstRow_);
    }
    BlockPlace placeOf(int row, int column);

    void readBlock(const CodeBlock& block, int row, int column);
    void readLeaf(const CodeBlock& block, int row, int column);
    void fillBlock(int row, int column, float value);
    void setActive(int row, int column, const ActiveWords& words);
    void emptyAround(int row, int column, int lastRow);

    const RayVolume& volume_;
    RayRule rule_;
    glm::ivec2 firstBlock_;
    std::size_t columns_;  // blocks, with those of the border
    std::size_t rows_;
    int firstRow_ = 0;
    std::vector<float> values_;         // [8][8 * rows_][8 * columns_]
    std::vector<std::uint8_t> active_;  // [8][8 * rows_][columns_]
    std::vector<Fill> fills_;           // [rows_][columns_]
    std::vector<std::uint8_t> empty_;   // [rows_][columns_]: the block holds nothing but `empty`
};

}  // namespace deltasplat
