// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "rays/picture_lines.h"
#include "rays/ray_volume.h"

namespace deltasplat {

/// Squares of lines of sight that may meet something of a volume: where there is little in a large
/// box, most meet nothing.
class LineCells {
  public:
    /// @param side  of a square, in lines
    LineCells(const PictureLines& lines, const RayVolume& volume, int side);

    /// Whether any of these lines may meet something.
    bool anyIn(const PixelBox& lines) const;

  private:
    PixelBox cellsOf(const PixelBox& lines) const;
    std::size_t indexOf(glm::ivec2 cell) const;

    int side_;
    PixelBox box_;               // in squares
    std::vector<bool> mayMeet_;  // of each, row by row; empty: all of them
};

}  // namespace deltasplat
