// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "rays/picture_lines.h"
#include "rays/ray_volume.h"
#include "rays/sight_ray.h"

namespace deltasplat {

/// Slices that a layer of blocks has.
struct BlockLayer {
    int block = 0;  ///< its number along the slice axis
    glm::ivec2 slices{0};
};

/// Where lines of the same axes run that lie beside each other.
class LineGroup {
  public:
    glm::dvec2 slices() const { return slices_; }
    /// Makes room for lines that meet something between two slices.
    void addSlices(const glm::dvec2& slices);
    /// Makes room for a line, once all slices are known.
    void addLine(const glm::dvec2& start, const glm::dvec2& slope);

    bool meets(const BlockLayer& layer) const {
        return slices_.y > layer.slices.x - 1 && slices_.x < layer.slices.y + 1;
    }
    /// Returns the largest of what blocks hold that lines may read of a layer, -infinity where
    /// there are none.
    float topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const;

  private:
    /// Where lines are at least and at most.
    struct Range {
        glm::dvec2 low{1e300};
        glm::dvec2 high{-1e300};
    };
    Range rangeAt(double slice) const;

    glm::dvec2 slices_{1e300, -1e300};
    Range first_, last_;  // a slice before the first, and behind the last
};

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
