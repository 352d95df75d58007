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

/// Where the base plane reads one slice's sheet, or a part of it: base pixel b at scale * b +
/// offset + fraction.
struct SheetReading {
    glm::ivec2 offset{0};
    glm::dvec2 fraction{0.0};  ///< 0 <= fraction < 1
    double scale = 1;          ///< exactly 1 in parallel projection
    glm::ivec2 origin{0};      ///< as SheetLayout::origin, of the part

    /// Where base pixel 0 reads the whole sheet. Places that are scaled are rounded: those of the
    /// whole, lest parts differ from it.
    glm::dvec2 startOfWhole() const { return glm::dvec2(offset) + glm::dvec2(origin) + fraction; }
};

SheetReading readingOf(const BasePlane& plane, const SheetLayout& layout, int slice);

/// Returns the base plane pixels that any of `sliceCount` slices from `firstSlice` on can reach, as
/// far as the plane goes.
PlaneBox reachOf(const BasePlane& plane, const SheetLayout& layout, int firstSlice, int sliceCount);

/// Returns the sheet pixels, of those that there are, that the pixels of a box read.
SheetBox readBox(const SheetReading& reading, const PlaneBox& box, const SheetLayout& layout);

/// Returns the base plane pixels [x, y) along an axis, of those of a box, that read any of the
/// sheet pixels [first, last).
glm::ivec2 readersOf(const SheetReading& reading, int axis, int first, int last,
                     const PlaneBox& box);

/// What readersOf() returns at scale 1, for many runs of sheet pixels: those that read [first,
/// last) are the box's pixels [first + before, last + after), counted from its first.
struct EvenReaders {
    EvenReaders(const SheetReading& reading, int axis, const PlaneBox& box)
        : count(box.size()[axis]) {
        // Where the plane lies farther away than that, the box has none of the pixels: neither it
        // nor a sheet has as many along an axis.
        constexpr std::int64_t kFar = 1 << 29;
        const std::int64_t shift = std::int64_t{reading.offset[axis]} + box.min[axis];
        before = int(std::clamp(-shift - (reading.fraction[axis] > 0 ? 2 : 1), -kFar, kFar));
        after = int(std::clamp(1 - shift, -kFar, kFar));
    }
    /// Becomes those that read at either place.
    void add(const EvenReaders& other) {
        before = std::min(before, other.before);
        after = std::max(after, other.after);
    }
    /// Returns those of the box, [x, y).
    glm::ivec2 of(int first, int last) const {
        return {std::clamp(first + before, 0, count), std::clamp(last + after, 0, count)};
    }

    int before;
    int after;
    int count;  ///< the box's
};

/// How far a reading reaches to both sides of a position, in sheet pixels: to the neighbours, or,
/// where base pixels lie farther apart, to the next of those.
inline double readingReach(const SheetReading& reading) {
    return reading.scale > 1 ? reading.scale : 1;
}

/// Where of a part of the base plane nothing is seen any more of what comes from behind, in cells
/// of 8x8 pixels.
class CoveredCells {
  public:
    static constexpr int kCellPixels = 8;

    /// @param box  the part: cells begin at its first pixel
    explicit CoveredCells(const PlaneBox& box = {});

    const PlaneBox& box() const { return box_; }
    glm::ivec2 size() const { return size_; }
    /// The pixels of a cell, as far as the box goes.
    PlaneBox pixelsOf(glm::ivec2 cell) const;
    /// The cells [x, y) along an axis that have any of the pixels [x, y), of those of the box.
    glm::ivec2 cellsOf(int axis, glm::ivec2 pixels) const;
    /// The same of pixels of the box, counted from its first. Without a branch, for it is asked for
    /// each row and column of every slice.
    static glm::ivec2 cellsOf(glm::ivec2 pixels) {
        const int mask = pixels.x < pixels.y ? ~0 : 0;
        return {mask & pixels.x / kCellPixels, mask & (pixels.y + kCellPixels - 1) / kCellPixels};
    }

    bool isCovered(glm::ivec2 cell) const { return covered_[placeOf(cell)] != 0; }
    /// Says that a cell is covered. Call settle() before asking for any but cells by themselves.
    void cover(glm::ivec2 cell) { covered_[placeOf(cell)] = 1; }
    void settle();

    bool any() const { return open_.back() < covered_.size(); }
    bool all() const { return open_.back() == 0; }
    /// Some rows of cells.
    class Rows {
      public:
        /// @param before  [columns + 1]: how many cells before a column are open above the first
        /// row
        /// @param after   likewise, above the row behind the last
        Rows(const std::uint32_t* before, const std::uint32_t* after)
            : before_(before), after_(after) {}
        /// Whether all cells of columns [x, y), x <= y, are covered; so are none at all.
        bool cover(glm::ivec2 columns) const {
            return after_[columns.y] - after_[columns.x] == before_[columns.y] - before_[columns.x];
        }

      private:
        const std::uint32_t* before_;
        const std::uint32_t* after_;
    };
    /// Rows [x, y), x <= y. To be used before anything else is covered.
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
    /// [rows + 1][columns + 1]: how many cells before a row and a column are not covered.
    std::vector<std::uint32_t> open_;
};

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
