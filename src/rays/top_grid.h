// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "delta/code_blocks.h"

namespace deltasplat {

/// What blocks hold at most, in cells as large as a block or, where blocks lie far apart, a power
/// of two times that: lines of sight ask it what they need not read.
class TopGrid {
  public:
    TopGrid() = default;
    /// @param blocks  whose positions are (x, y, z)
    /// @param tops    of each block
    TopGrid(std::span<const CodeBlock> blocks, std::span<const float> tops);

    /// Returns the largest top of the blocks between two positions, or of more; -infinity where
    /// there are none.
    float topBetween(glm::ivec3 low, glm::ivec3 high) const;

  private:
    glm::ivec3 first_{0};  // in cells
    glm::ivec3 size_{0};
    int shift_ = 0;  // a cell has 2^shift_ blocks along each axis
    std::vector<float> tops_;
};

}  // namespace deltasplat
