// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volume/code_blocks.h"
#include "words/value_mixer.h"

namespace deltasplat {

/// Tells which blocks may be seen where a voxel's neighbours have a say: once voxels are divided,
/// mixed values lie between those of a block and of its neighbours, and may be seen where the
/// voxels themselves are clear; and so it is beside a surface.
class MixedSight {
  public:
    /// @param slotMap    [kSlotCount]: 0 for the slots of levels that are clear
    /// @param byAllSides  whether neighbours along all axes have a say, though voxels be divided
    ///                   along none; then places without any active voxel are listed, too
    MixedSight(const ValueMixer& mixer, std::span<const Slot> slotMap, bool byAllSides);

    /// Whether any voxel may be seen that is mixed within a window.
    bool canBeSeen(const MixWindow& window) const;
    /// Lists the blocks that may be seen, ordered by u, then v, then slice. Slots of tiles are
    /// code + 1.
    /// @param histogram  of the volume's codes
    std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                      std::span<const std::uint64_t> histogram) const;

  private:
    int seenBefore(Code code) const { return before_[std::size_t(mixer_.levelOf(code))]; }
    bool isSeenBetween(Code low, Code high) const {
        return before_[std::size_t(mixer_.levelOf(high)) + 1] != seenBefore(low);
    }

    std::vector<Slot> seenCodes(std::span<const std::uint64_t> histogram) const;

    const ValueMixer& mixer_;
    bool byAllSides_;
    std::vector<int> before_;  // [kSlotCount]: how many levels before each can be seen
};

}  // namespace deltasplat
