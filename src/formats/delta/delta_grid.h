// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "volume/code_blocks.h"
#include "volume/slab_layout.h"
#include "volume/tree_types.h"

namespace deltasplat {

/// The deltas of a volume in (slice, u, v) index space. A leaf holds 8x8x8 deltas, slice slowest:
/// the 64 deltas of a slice are contiguous, and bit 8 * u + v of its mask word marks each delta.
struct DeltaTree {
    using Leaf = openvdb::Int32Tree::LeafNodeType;

    openvdb::Int32Tree::Ptr deltas = std::make_shared<openvdb::Int32Tree>(0);
    std::vector<const Leaf*> leaves;  ///< leaves of `deltas`, by slice, u and v
};

/// A block's slots and the slice before it: all that its deltas depend on.
struct BlockWindow {
    std::array<Slot, 64> before{};  ///< empty at a slab's start or behind a gap
    BlockSlots slots;

    const Slot* slice(int s) const { return &slots[64 * s]; }
    const Slot* sliceBefore(int s) const { return s == 0 ? before.data() : slice(s - 1); }
};

/// The places of a volume that can have visible voxels or deltas: its blocks, and the gap behind a
/// block that ends within a slab, where its slots must be taken away.
class BlockWindows {
  public:
    BlockWindows(const BlockReader& reader, const SlabLayout& layout);

    std::size_t count() const { return places_.size(); }
    glm::ivec3 position(std::size_t i) const {
        return reader_.blocks()[places_[i].block].position + glm::ivec3(places_[i].behind, 0, 0);
    }
    void read(std::size_t i, BlockWindow& window) const;

  private:
    struct Place {
        std::size_t block;
        bool behind;
    };
    // Whether block i follows block i - 1 in the same slab.
    bool continues(std::size_t i) const;

    const BlockReader& reader_;
    SlabLayout layout_;
    std::vector<Place> places_;
};

/// A block's visible voxels, and those that differ from the slice before: bit 8 * u + v of word s.
struct BlockChanges {
    std::array<std::uint64_t, 8> visible{};
    std::array<std::uint64_t, 8> changed{};
};

std::vector<BlockChanges> findChanges(const BlockWindows& windows, const SlabLayout& layout);

}  // namespace deltasplat
