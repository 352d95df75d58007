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

/// The deltas of one volume in (slice, u, v) index space. A leaf holds 8x8x8 of them, slice
/// slowest: the 64 changes of one slice are contiguous, and one 64-bit mask word (bit 8 * u + v)
/// says which there are.
struct DeltaTree {
    using Leaf = openvdb::Int32Tree::LeafNodeType;

    openvdb::Int32Tree::Ptr deltas = std::make_shared<openvdb::Int32Tree>(0);
    std::vector<const Leaf*> leaves;  ///< of that, ordered by slice, then u, then v
};

/// A block's slots with the slice before it: everything that its deltas depend on.
struct BlockWindow {
    std::array<Slot, 64> before{};  ///< empty where a slab starts or nothing lies there
    BlockSlots slots;

    const Slot* slice(int s) const { return &slots[64 * s]; }
    const Slot* sliceBefore(int s) const { return s == 0 ? before.data() : slice(s - 1); }
};

/// The places of a volume where visible voxels or deltas can be: its blocks, and the gap behind a
/// block that ends within a slab, where what it showed must be taken away.
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
    // Whether block i lies right behind block i - 1 and in the same slab.
    bool continues(std::size_t i) const;

    const BlockReader& reader_;
    SlabLayout layout_;
    std::vector<Place> places_;
};

/// Which of a block's voxels are visible, and which differ from the slice before: bit 8 * u + v of
/// word s.
struct BlockChanges {
    std::array<std::uint64_t, 8> visible{};
    std::array<std::uint64_t, 8> changed{};
};

/// Returns the changes at every place of `windows`. Multi-threaded.
std::vector<BlockChanges> findChanges(const BlockWindows& windows, const SlabLayout& layout);

}  // namespace deltasplat
