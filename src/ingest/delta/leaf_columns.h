// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "ingest/delta/delta_columns.h"
#include "ingest/vdb/vdb_leaves.h"

namespace deltasplat {

/// Deltas that are voxels of a file's leaves.
class LeafColumns : public DeltaColumns {
  public:
    /// @param leaves  of int32, at (slice, u, v)
    explicit LeafColumns(const VdbLeaves& leaves);

    const std::vector<DeltaColumn>& columns() const override { return columns_; }
    std::size_t blocks() const override { return order_.size(); }
    std::unique_ptr<DeltaWalker> walker() const override;

    /// A leaf, and its block.
    struct Placed {
        glm::ivec3 block;
        const VdbLeaf* leaf;
    };

  private:
    const VdbLeaves& leaves_;
    std::vector<Placed> order_;         // by u, v and slice
    std::vector<DeltaColumn> columns_;  // of these
};

}  // namespace deltasplat
