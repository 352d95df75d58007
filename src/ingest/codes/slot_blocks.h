// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "deltasplat/ingest/slot.h"

namespace deltasplat {

struct SlabFacts;

/// A slot in 16 bits: 0 = empty, else code + 1; for codes below 65535.
using ShortSlot = std::uint16_t;

/// An 8x8x8 block with active voxels.
struct SlotBlock {
    glm::ivec3 position{0};            ///< of its first voxel in (slice, u, v) order, divided by 8
    const ShortSlot* slots = nullptr;  ///< [slice][u][v]; null: all are `tileSlot`
    Slot tileSlot = kEmptySlot;
    Code lowest = 0;  ///< range of the active voxels' codes
    Code highest = 0;
};

/// The codes of a volume as they lie along a slice axis: what words are made of, block by block,
/// without a tree.
class SlotBlocks {
  public:
    /// @param blocks   by u, then v, then slice; each has active voxels
    /// @param storage  what they point into
    SlotBlocks(int sliceAxis, std::vector<SlotBlock> blocks,
               std::vector<std::unique_ptr<ShortSlot[]>> storage);

    int sliceAxis() const { return sliceAxis_; }
    const std::vector<SlotBlock>& blocks() const { return blocks_; }
    /// Returns a block by its position, or null if there is none. Thread-safe.
    const SlotBlock* find(const glm::ivec3& position) const;
    std::size_t memoryBytes() const;

    /// What is known of the whole volume, if these are the blocks of some slices only; else null.
    const SlabFacts* facts() const { return facts_.get(); }
    void setFacts(std::shared_ptr<const SlabFacts> facts) { facts_ = std::move(facts); }

  private:
    int sliceAxis_;
    std::shared_ptr<const SlabFacts> facts_;
    std::vector<SlotBlock> blocks_;
    std::vector<std::unique_ptr<ShortSlot[]>> storage_;
    // Where the columns of a rectangle of u and v begin among the blocks; empty if it is mostly
    // empty.
    glm::ivec2 firstColumn_{0};
    glm::ivec2 columns_{0};
    std::vector<std::size_t> begins_;  // [u][v], and one more
};

}  // namespace deltasplat
