// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "delta/code_blocks.h"
#include "delta/slice_mixer.h"

namespace deltasplat {

/// Tells which blocks may be seen once slices are put between those of a volume: mixed values lie
/// between those of a block and of its neighbours along the slice axis, and may be seen where the
/// voxels themselves are clear.
class MixedSight {
  public:
    /// @param slotMap  [kSlotCount]: 0 for the slots of levels that are clear
    MixedSight(const SliceMixer& mixer, std::span<const Slot> slotMap);

    /// Whether any voxel may be seen that is mixed within blocks which follow each other.
    bool canBeSeen(std::span<const CodeBlock> blocks) const;
    /// Lists the blocks that may be seen, and those active ones beside them that they are mixed
    /// with, ordered by u, then v, then slice. Slots of tiles are code + 1.
    /// @param histogram  of the volume's codes
    std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                      std::span<const std::uint64_t> histogram) const;

  private:
    int seenBefore(Code code) const { return before_[std::size_t(mixer_.levelOf(code))]; }
    bool isSeenBetween(Code low, Code high) const {
        return before_[std::size_t(mixer_.levelOf(high)) + 1] != seenBefore(low);
    }
    std::vector<Slot> seenCodes(std::span<const std::uint64_t> histogram) const;

    const SliceMixer& mixer_;
    std::vector<int> before_;  // [kSlotCount]: how many levels before each can be seen
};

}  // namespace deltasplat
