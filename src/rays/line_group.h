// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "rays/sight_ray.h"
#include "rays/top_grid.h"

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

}  // namespace deltasplat
