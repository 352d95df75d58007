// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
    using Room = VdbLeaves::Room<Stored>;

    /// @param topology  all but the values of leaves
    /// @param leaves    in the tree's order
    /// @param passes    over all leaves, how many are to be expected
    /// @param listener  hears how far leaves are asked for
    FileLeaves(const Tree& topology, const VdbLeaves& leaves, int passes, const Listener& listener)
        : tree_(topology), packed_(leaves), passes_(passes), progress_(listener) {
        topology.getNodes(leaves_);
    }

    const Tree& tree() const { return tree_; }
    std::size_t count() const { return leaves_.size(); }
    const typename Tree::LeafNodeType& operator[](std::size_t i) const { return *leaves_[i]; }
    /// Of a leaf whose values are damaged there are none.
    std::span<const Stored> values(std::size_t i, Room& room) const {
        if (i == 0) ++pass_;
        if (i % kLeafRun == 0) {
            const double done = pass_ - 1 + double(i) / double(leaves_.size());
            progress_.report(std::min(1.0, done / passes_));
        }
        VdbLeaves::Mask mask;
        const auto values = packed_.activeValues(packed_.leaves()[i], mask, room);
        if (values && isMaskOf(*leaves_[i], mask)) return *values;
        areDamaged_ = true;
        return {};
    }
    /// Whether any that were asked for were.
    bool areDamaged() const { return areDamaged_; }

  private:
    // Sums of masks may be alike where these are not.
    static bool isMaskOf(const typename Tree::LeafNodeType& leaf, const VdbLeaf::Mask& mask) {
        for (openvdb::Index x = 0; x < mask.size(); ++x) {
            if (leaf.valueMask().template getWord<std::uint64_t>(x) != mask[x]) return false;
        }
        return true;
    }

    const Tree& tree_;
    const VdbLeaves& packed_;
    std::vector<const typename Tree::LeafNodeType*> leaves_;
    int passes_;
    mutable std::atomic<int> pass_ = 0;
    mutable SharedProgress progress_;
    mutable std::atomic<bool> areDamaged_ = false;
};

}  // namespace deltasplat
