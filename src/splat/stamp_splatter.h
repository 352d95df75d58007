// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "splat/slice_blocks.h"
#include "splat/stamp_kernels.h"

namespace deltasplat {

/// Makes sheets by stamping footprints of any size, one by one.
class StampSplatter {
  public:
    /// @param largest  of the layouts to come
    /// @param sheet    of that layout; zero whenever a slab begins
    /// @param digit    of colours
    StampSplatter(const SplatInput& input, const SheetLayout& largest, Sheet& sheet,
                  DigitPlace digit = {});

    /// Takes on a layout, which the sheet must have by then.
    void setLayout(const SheetLayout& layout);
    /// Makes the sheet that of the slice, after the one before it if it is not whole.
    /// @param needed  what will be read; the rest is made when it is
    void splat(int slice, bool whole, const NeededPixels& needed);
    /// Makes everything as it was before the first slice.
    void clear();

  private:
    void add(glm::ivec2 block, std::uint64_t voxels, const SeenWord& word, bool whole);

    const std::vector<ClassTable::Color>& colors_;
    bool hasOwn_;  // whether voxels have colours of their own
    SliceBlocks blocks_;
    Sheet& sheet_;
    StampWeights weights_;
    std::size_t mostBlocks_;  // of any layout
    /// Of a voxel's footprint, from its block's first one.
    std::array<std::uint32_t, 64> placeInBlock_;
    // Of the slice in hand, and [block][64], of slabs that are not whole; of own colours the second
    // ones.
    std::vector<BlockStamps> stamped_;
    std::pmr::vector<ClassIndex> shown_;
    std::vector<ColorStamps> stampedColors_;
    std::pmr::vector<ClassTable::Color> shownColors_;
};

}  // namespace deltasplat
