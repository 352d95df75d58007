// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rays/picture_lines.h"
#include "rays/ray_volume.h"

namespace deltasplat {

/// Which blocks squares of lines of sight may meet: where there is little in a large box, most
/// squares meet none.
class LineCells {
  public:
    /// @param side  of a square, in lines
    LineCells(const PictureLines& lines, const RayVolume& volume, int side);

    /// Whether blocks are so many that nobody knows who meets which.
    bool areUnknown() const { return ends_.empty(); }
    /// Numbers of the blocks that any of these lines may meet, in order.
    std::vector<std::uint32_t> blocksBehind(const PixelBox& lines) const;

  private:
    PixelBox cellsOf(const PixelBox& lines) const;
    std::size_t indexOf(glm::ivec2 cell) const;

    int side_;
    PixelBox box_;                       // in squares
    std::vector<std::size_t> ends_;      // of the blocks of each, row by row, which begin at its
                                         // predecessor's
    std::vector<std::uint32_t> blocks_;  // of all
};

}  // namespace deltasplat
