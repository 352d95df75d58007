// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "splat/covered_cells.h"
#include "splat/sheet_reading.h"

namespace deltasplat {

/// What of a slice's sheet is read by covered pixels of the base plane alone, so that it need not
/// be made.
class SheetCover {
  public:
    /// Takes on a slice, or what is the same in several, of which one is the first and one the
    /// last: those between are read from between.
    /// @param cells  must outlive the use
    void set(const CoveredCells& cells, const SheetReading& first, const SheetReading& last,
             const SheetLayout& layout);

    /// A row of blocks, or of tiles. Valid until the next set(), while the cells stay as they are.
    class Row {
      public:
        /// Whether all readers are covered of what the voxels of the block in a column reach, or of
        /// the tile's pixels.
        bool hides(int column) const { return cells_.cover(columns_[column]); }
        /// The same of all from column `first` to `last`; false where that takes more than a look.
        bool hides(int first, int last) const {
            const glm::ivec2 begin = columns_[first];
            const glm::ivec2 end = columns_[last];
            // What nobody reads has no place among the others.
            if (begin.x >= begin.y || end.x >= end.y) return false;
            return cells_.cover({begin.x, end.y});
        }

      private:
        friend class SheetCover;
        Row(const CoveredCells& cells, const std::vector<glm::ivec2> (&axes)[2], int row)
            : cells_(cells.rows(axes[1][std::size_t(row)])), columns_(axes[0].data()) {}

        CoveredCells::Rows cells_;
        const glm::ivec2* columns_;
    };
    Row blockRow(int row) const { return {*cells_, blocks_, row}; }
    Row tileRow(int row) const { return {*cells_, tiles_, row}; }
    /// Clears in rows of bits, a bit for each tile of a row of tiles, those of hidden ones.
    /// @param rows   [any number][words]
    void clearHidden(int row, std::size_t words, std::span<std::uint64_t> rows) const;

  private:
    const CoveredCells* cells_ = nullptr;
    // Of each column (v) and each row (u) of blocks, and of tiles, the cells [x, y) that read it.
    std::vector<glm::ivec2> blocks_[2];
    std::vector<glm::ivec2> tiles_[2];
};

/// What of a sheet will be read.
struct NeededPixels {
    /// Rows [firstRow, lastRow).
    int firstRow;
    int lastRow;
    /// Of these, what it hides is not; null: nothing is hidden.
    const SheetCover* cover = nullptr;
    /// What is not needed in this slice, and in none of those to come; null likewise.
    const SheetCover* fromNowOn = nullptr;
    /// Rows [x, y) that are needed in this slice or any of those to come.
    glm::ivec2 rowsFromNowOn{0, 1 << 30};
};

}  // namespace deltasplat
