// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "splat/sheet.h"
#include "view/base_plane.h"

namespace deltasplat {

/// How the base plane reads a slice's sheet or part: pixel b at scale * b + offset + fraction.
struct SheetReading {
    glm::ivec2 offset{0};
    glm::dvec2 fraction{0.0};  ///< 0 <= fraction < 1
    double scale = 1;          ///< exactly 1 in parallel projection
    glm::ivec2 origin{0};      ///< the part's SheetLayout::origin

    /// Base pixel 0 on the whole sheet, where scaled places are rounded, so that parts agree.
    glm::dvec2 startOfWhole() const { return glm::dvec2(offset) + glm::dvec2(origin) + fraction; }
};

SheetReading readingOf(const BasePlane& plane, const SheetLayout& layout, int slice);

/// Returns the base plane pixels that any of `sliceCount` slices from `firstSlice` on can reach.
PlaneBox reachOf(const BasePlane& plane, const SheetLayout& layout, int firstSlice, int sliceCount);

/// Returns the existing sheet pixels that the pixels of a box read.
SheetBox readBox(const SheetReading& reading, const PlaneBox& box, const SheetLayout& layout);

/// Returns a box's pixels [x, y) along an axis that read any of sheet pixels [first, last).
glm::ivec2 readersOf(const SheetReading& reading, int axis, int first, int last,
                     const PlaneBox& box);

/// readersOf() at scale 1 for many runs of sheet pixels: [first, last) is read by pixels [first +
/// before, last + after) of the box, counted from its first.
struct EvenReaders {
    EvenReaders(const SheetReading& reading, int axis, const PlaneBox& box)
        : count(box.size()[axis]) {
        // Farther away, the box has none of the pixels: neither it nor a sheet is as large.
        constexpr std::int64_t kFar = 1 << 29;
        const std::int64_t shift = std::int64_t{reading.offset[axis]} + box.min[axis];
        before = int(std::clamp(-shift - (reading.fraction[axis] > 0 ? 2 : 1), -kFar, kFar));
        after = int(std::clamp(1 - shift, -kFar, kFar));
    }
    /// Adds the pixels that read at the other place.
    void add(const EvenReaders& other) {
        before = std::min(before, other.before);
        after = std::max(after, other.after);
    }
    /// Returns pixels of the box, [x, y).
    glm::ivec2 of(int first, int last) const {
        return {std::clamp(first + before, 0, count), std::clamp(last + after, 0, count)};
    }

    int before;
    int after;
    int count;  ///< of the box
};

/// Sheet pixels read to both sides of a position: to the neighbour or, if farther, base pixel.
inline double readingReach(const SheetReading& reading) {
    return reading.scale > 1 ? reading.scale : 1;
}

/// Cells of 8x8 base plane pixels in which nothing from behind is visible any more.
class CoveredCells {
  public:
    static constexpr int kCellPixels = 8;

    /// @param box  a part of the base plane; cells begin at its first pixel
    explicit CoveredCells(const PlaneBox& box = {});

    const PlaneBox& box() const { return box_; }
    glm::ivec2 size() const { return size_; }
    /// The pixels of a cell within the box.
    PlaneBox pixelsOf(glm::ivec2 cell) const;
    /// The cells [x, y) along an axis that have any of the box's pixels [x, y).
    glm::ivec2 cellsOf(int axis, glm::ivec2 pixels) const;
    /// For pixels from the box's first. Branchless: runs per row and column of every slice.
    static glm::ivec2 cellsOf(glm::ivec2 pixels) {
        const int mask = pixels.x < pixels.y ? ~0 : 0;
        return {mask & pixels.x / kCellPixels, mask & (pixels.y + kCellPixels - 1) / kCellPixels};
    }

    bool isCovered(glm::ivec2 cell) const { return covered_[placeOf(cell)] != 0; }
    /// Covers a cell. Call settle() before asking for more than single cells.
    void cover(glm::ivec2 cell) { covered_[placeOf(cell)] = 1; }
    void settle();

    bool any() const { return open_.back() < covered_.size(); }
    bool all() const { return open_.back() == 0; }
    class Rows {
      public:
        /// @param before  [columns + 1]: open cells before a column, above the first row
        /// @param after   likewise, above the row behind the last
        Rows(const std::uint32_t* before, const std::uint32_t* after)
            : before_(before), after_(after) {}
        /// Whether all cells of columns [x, y), x <= y, are covered, or there are none.
        bool cover(glm::ivec2 columns) const {
            return after_[columns.y] - after_[columns.x] == before_[columns.y] - before_[columns.x];
        }

      private:
        const std::uint32_t* before_;
        const std::uint32_t* after_;
    };
    /// Rows [x, y), x <= y, for use until cells are covered.
    Rows rows(glm::ivec2 rows) const { return {openAbove(rows.x), openAbove(rows.y)}; }

  private:
    std::size_t placeOf(glm::ivec2 cell) const {
        return std::size_t(cell.y) * std::size_t(size_.x) + std::size_t(cell.x);
    }
    const std::uint32_t* openAbove(int row) const {
        return &open_[std::size_t(row) * std::size_t(size_.x + 1)];
    }

    PlaneBox box_;
    glm::ivec2 size_{0};
    std::vector<std::uint8_t> covered_;  // [rows][columns]
    /// [rows + 1][columns + 1]: open cells before a row and a column.
    std::vector<std::uint32_t> open_;
};

/// Parts of a slice's sheet that only covered base plane pixels read, so they need not be made.
class SheetCover {
  public:
    /// Takes a slice, or several slices with readings between `first` and `last`.
    /// @param cells  must outlive the use
    void set(const CoveredCells& cells, const SheetReading& first, const SheetReading& last,
             const SheetLayout& layout);

    /// A row of blocks or tiles. Valid until set(), while cells stay as they are.
    class Row {
      public:
        /// Whether every reader of a tile, or of the tiles that a block reaches, is covered.
        bool hides(int column) const { return cells_.cover(columns_[column]); }
        /// Tests columns `first` to `last`; false where one look does not suffice.
        bool hides(int first, int last) const {
            const glm::ivec2 begin = columns_[first];
            const glm::ivec2 end = columns_[last];
            // Unread columns have no place among the others.
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
    /// Clears the bits of hidden tiles of a row of tiles, in rows of a bit per tile.
    /// @param rows  [any number][words]
    void clearHidden(int row, std::size_t words, std::span<std::uint64_t> rows) const;

  private:
    const CoveredCells* cells_ = nullptr;
    // [column (v)] and [row (u)] of blocks, and of tiles: the cells [x, y) that read it.
    std::vector<glm::ivec2> blocks_[2];
    std::vector<glm::ivec2> tiles_[2];
};

/// The pixels of a sheet that will be read.
struct NeededPixels {
    int firstRow;
    int lastRow;
    /// Hides pixels of these rows; null: none.
    const SheetCover* cover = nullptr;
    /// Hides pixels that this and all later slices do not need; null: none.
    const SheetCover* fromNowOn = nullptr;
    /// Rows [x, y) that this or later slices need.
    glm::ivec2 rowsFromNowOn{0, 1 << 30};
};

}  // namespace deltasplat
