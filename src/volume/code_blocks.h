// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <tuple>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "hwy/cache_control.h"
#include "volume/code_tree.h"
#include "volume/seen_cone.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

/// Prefetches the codes of the leaf that is read next, because leaves lie anywhere in memory.
inline void fetchCodes(const CodeTree::Leaf& leaf) {
    constexpr std::size_t kLineBytes = 64;
    const Code* const codes = leaf.buffer().data();
    for (std::size_t i = 0; i < 512; i += kLineBytes / sizeof(Code)) hwy::Prefetch(codes + i);
}

/// An 8x8x8 block with active voxels, (slice, u, v): a leaf, a piece of a tile or a SlotBlock.
struct CodeBlock {
    glm::ivec3 position{0};                ///< of its first voxel, divided by 8
    const CodeTree::Leaf* leaf = nullptr;  ///< null for a piece of a tile, and if `slots` is set
    Slot tileSlot = kEmptySlot;            ///< slot of all voxels, if `leaf` and `slots` are null
    /// Leaf of inactive voxels with values of their own, or null.
    const CodeTree::Leaf* inactive = nullptr;
    /// Range of the active voxels' codes, if `leaf` or `slots` is set.
    Code lowest = 0;
    Code highest = 0;
    const ShortSlot* slots = nullptr;  ///< as SlotBlock::slots; set by listBlocks only
};

/// Compares in the order u, then v, then slice.
inline bool comesBefore(const CodeBlock& a, const CodeBlock& b) {
    return std::tie(a.position.y, a.position.z, a.position.x) <
           std::tie(b.position.y, b.position.z, b.position.x);
}

/// Whether two blocks lie in the same column along the slice axis, at any distance.
inline bool shareColumn(const CodeBlock& a, const CodeBlock& b) {
    return a.position.y == b.position.y && a.position.z == b.position.z;
}

/// Whether `block` is the direct neighbour behind `before` along the slice axis.
inline bool follows(const CodeBlock& before, const CodeBlock& block) {
    return block.position == before.position + glm::ivec3(1, 0, 0);
}

/// Slots of a block, `[slice][u][v]`.
using BlockSlots = std::array<Slot, 512>;

/// Reads the blocks of a code tree as slots along one slice axis.
class BlockReader {
  public:
    /// @param inactive  null, or a tree of voxels inactive in `codes`; slots are kSlotCount + value
    /// @param slotMap   as DeltaOptions::slotMap; must outlive the reader
    /// @param seen      null, or a cone: blocks outside of it are left out
    BlockReader(const CodeTree& codes, const CodeTree* inactive, int sliceAxis,
                std::span<const Slot> slotMap, const SeenCone* seen = nullptr);

    /// The blocks that may have slots other than empty, ordered by u, then v, then slice.
    const std::vector<CodeBlock>& blocks() const { return blocks_; }
    std::vector<CodeBlock> takeBlocks() && { return std::move(blocks_); }
    void readBlock(const CodeBlock& block, BlockSlots& slots) const;
    /// Reads the slots of a block's last slice, `[u][v]`.
    void readLastSlice(const CodeBlock& block, std::span<Slot, 64> slots) const;

  private:
    std::vector<CodeBlock> listBlocks(const CodeTree& codes, const CodeTree* inactive,
                                      const SeenCone* seen) const;
    void addTile(const openvdb::CoordBBox& box, Slot slot, const SeenCone* seen,
                 std::vector<CodeBlock>& blocks) const;
    void mergeDoubles();
    void readInactive(const CodeBlock& block, int firstSlice, Slot* slots) const;
    Slot slotOf(Code code) const { return slotMap_.empty() ? code + 1 : slotMap_[code + 1]; }

    std::span<const Slot> slotMap_;
    int sliceAxis_;
    std::vector<CodeBlock> blocks_;
};

/// Lists the blocks that may have slots other than empty, as BlockReader does. If the codes are
/// SlotBlocks along this axis, the list has these blocks, and no tree is made.
std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                  std::span<const Slot> slotMap, const SeenCone* seen = nullptr);

/// The slots that a column of blocks currently holds, `[u][v]`.
using HeldSlots = std::array<Slot, 64>;

/// Updates held slots in slice order: held = next(held, slot) per voxel, then use(i, held).
template <typename Next, typename Use>
void holdSlots(const BlockSlots& slots, HeldSlots& held, const Next& next, const Use& use) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Slot& slot = held[i & 63];
        slot = next(slot, slots[i]);
        use(i, slot);
    }
}

}  // namespace deltasplat
