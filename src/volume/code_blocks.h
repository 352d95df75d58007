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

/// Brings the codes of a leaf nearer that will be read next: leaves lie anywhere, and nobody else
/// can tell where.
inline void fetchCodes(const CodeTree::Leaf& leaf) {
    constexpr std::size_t kLineBytes = 64;
    const Code* const codes = leaf.buffer().data();
    for (std::size_t i = 0; i < 512; i += kLineBytes / sizeof(Code)) hwy::Prefetch(codes + i);
}

/// An 8x8x8 block of active voxels, in (slice, u, v) order: a leaf of the code tree, a piece of a
/// tile, or one of SlotBlocks.
struct CodeBlock {
    glm::ivec3 position{0};                ///< of its first voxel, divided by 8
    const CodeTree::Leaf* leaf = nullptr;  ///< null for a piece of a tile, and with `slots`
    Slot tileSlot = kEmptySlot;            ///< of all voxels, if there is neither
    /// Leaf of inactive voxels that hold a value of their own; may be null.
    const CodeTree::Leaf* inactive = nullptr;
    /// Range of the active voxels' codes, where there is a leaf or `slots`.
    Code lowest = 0;
    Code highest = 0;
    const ShortSlot* slots = nullptr;  ///< as SlotBlock::slots; null unless listBlocks found them
};

/// Whether a block comes before another: ordered by u, then v, then slice.
inline bool comesBefore(const CodeBlock& a, const CodeBlock& b) {
    return std::tie(a.position.y, a.position.z, a.position.x) <
           std::tie(b.position.y, b.position.z, b.position.x);
}

/// Whether two blocks lie one behind the other along the slice axis, however far.
inline bool shareColumn(const CodeBlock& a, const CodeBlock& b) {
    return a.position.y == b.position.y && a.position.z == b.position.z;
}

/// Whether a block lies right behind another along the slice axis.
inline bool follows(const CodeBlock& before, const CodeBlock& block) {
    return block.position == before.position + glm::ivec3(1, 0, 0);
}

/// Slots of a block, `[slice][u][v]`.
using BlockSlots = std::array<Slot, 512>;

/// Reads the blocks of a code tree as slots along one slice axis.
class BlockReader {
  public:
    /// @param inactive  null, or a tree that is active where `codes` is not: voxels whose slot is
    ///                  kSlotCount + its value
    /// @param slotMap   as DeltaOptions::slotMap; must outlive the reader
    /// @param seen      null, or leaves out blocks that it does not see
    BlockReader(const CodeTree& codes, const CodeTree* inactive, int sliceAxis,
                std::span<const Slot> slotMap, const SeenCone* seen = nullptr);

    /// The blocks that may have slots other than empty, ordered by u, then v, then slice.
    const std::vector<CodeBlock>& blocks() const { return blocks_; }
    std::vector<CodeBlock> takeBlocks() && { return std::move(blocks_); }
    /// Returns the slots of a block.
    void readBlock(const CodeBlock& block, BlockSlots& slots) const;
    /// Returns the slots of a block's last slice, `[u][v]`.
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

/// Lists the blocks of a volume's codes that may have slots other than empty, as BlockReader does.
/// Where codes are SlotBlocks along this axis, these are what is listed, and no tree is made.
std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                  std::span<const Slot> slotMap, const SeenCone* seen = nullptr);

/// What the voxels of a column of blocks are held as, `[u][v]`; empty: as nothing.
using HeldSlots = std::array<Slot, 64>;

/// Takes a block's voxels slice by slice through what they are held as: each becomes
/// next(held, slot), compared with its true slot every time, and use(i, slot) gets it.
template <typename Next, typename Use>
void holdSlots(const BlockSlots& slots, HeldSlots& held, const Next& next, const Use& use) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Slot& slot = held[i & 63];
        slot = next(slot, slots[i]);
        use(i, slot);
    }
}

}  // namespace deltasplat
