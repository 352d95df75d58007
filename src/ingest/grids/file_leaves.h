// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/grids/grid_values.h"
#include "ingest/vdb/vdb_leaves.h"
#include "shared_progress.h"

namespace deltasplat {

/// What TreeLeaves is, of a tree whose leaves' values are still in their file, packed.
/// @tparam Stored  what they are there: the tree's own type, or the std::uint16_t that a half is
template <typename Tree, typename Stored = typename Tree::ValueType>
class FileLeaves {
  public:
    using Room = VdbLeaves::Values<Stored>;

    /// @param topology  all but the values of leaves
    /// @param leaves    in the tree's order
    /// @param listener  hears how far leaves are asked for, in each pass over them
    FileLeaves(const Tree& topology, const VdbLeaves& leaves, const Listener& listener)
        : tree_(topology), packed_(leaves), progress_(listener) {
        topology.getNodes(leaves_);
    }

    const Tree& tree() const { return tree_; }
    std::size_t count() const { return leaves_.size(); }
    const typename Tree::LeafNodeType& operator[](std::size_t i) const { return *leaves_[i]; }
    /// Of a leaf whose values are damaged there are none.
    std::span<const Stored> values(std::size_t i, Room& room) const {
        if (i % kLeafRun == 0) progress_.report(double(i) / double(leaves_.size()));
        const VdbLeaf& leaf = packed_.leaves()[i];
        const VdbLeaves::Mask mask = packed_.maskOf(leaf);
        const auto values = packed_.activeValues<Stored>(leaf, mask, room);
        if (values.size() == leaves_[i]->onVoxelCount() && isMaskOf(*leaves_[i], mask))
            return values;
        areDamaged_ = true;
        return {};
    }
    /// Whether any that were asked for were.
    bool areDamaged() const { return areDamaged_; }

  private:
    // A mask is in the file twice: with the topology, and with the values.
    static bool isMaskOf(const typename Tree::LeafNodeType& leaf, const VdbLeaves::Mask& mask) {
        for (openvdb::Index x = 0; x < mask.size(); ++x) {
            if (leaf.valueMask().template getWord<std::uint64_t>(x) != mask[x]) return false;
        }
        return true;
    }

    const Tree& tree_;
    const VdbLeaves& packed_;
    std::vector<const typename Tree::LeafNodeType*> leaves_;
    mutable SharedProgress progress_;
    mutable std::atomic<bool> areDamaged_ = false;
};

}  // namespace deltasplat
