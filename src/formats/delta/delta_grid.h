// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
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

}  // namespace deltasplat
