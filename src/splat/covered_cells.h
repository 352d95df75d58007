// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "view/base_plane.h"

namespace deltasplat {

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

}  // namespace deltasplat
