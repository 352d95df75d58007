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

    bool isCovered(glm::ivec2 cell) const { return covered_[placeOf(cell)] != 0; }
    /// Says that a cell is covered. Call settle() before asking for any but cells by themselves.
    void cover(glm::ivec2 cell) { covered_[placeOf(cell)] = 1; }
    void settle();

    bool any() const { return open_.back() < covered_.size(); }
    bool all() const { return open_.back() == 0; }
    /// Whether all cells are covered of columns [x, y) and rows [x, y); so are none at all.
    bool cover(glm::ivec2 columns, glm::ivec2 rows) const {
        if (columns.x >= columns.y || rows.x >= rows.y) return true;
        return openBefore(columns.y, rows.y) + openBefore(columns.x, rows.x) ==
               openBefore(columns.x, rows.y) + openBefore(columns.y, rows.x);
    }

  private:
    std::size_t placeOf(glm::ivec2 cell) const {
        return std::size_t(cell.y) * std::size_t(size_.x) + std::size_t(cell.x);
    }
    std::uint32_t openBefore(int column, int row) const {
        return open_[std::size_t(row) * std::size_t(size_.x + 1) + std::size_t(column)];
    }

    PlaneBox box_;
    glm::ivec2 size_{0};
    std::vector<std::uint8_t> covered_;  // [rows][columns]
    /// [rows + 1][columns + 1]: how many cells before a row and a column are not covered.
    std::vector<std::uint32_t> open_;
};

}  // namespace deltasplat
