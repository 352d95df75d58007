// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <memory>

#include "deltasplat/ingest/volume.h"
#include "ingest/grids/tree_grid.h"

namespace deltasplat {

struct PackedGrid;

/// A volume's own grid, in its own value type: every value, inactive ones included, background,
/// transform, class and metadata.
struct SourceGrid {
    TreeGrid grid;  ///< without a tree if `packed` is there
    /// .vdb: the metadata of the file itself, the same for all of its grids.
    VdbMetadata fileMetadata = {};
    /// Of a volume that is read to be compared alone: values that are still in their file.
    std::shared_ptr<const PackedGrid> packed = nullptr;
    /// The grid that makeVolume() was given; null of others.
    openvdb::GridBase::ConstPtr given = nullptr;
};

/// Whether integers of the source are unsigned ones by their bits. Their type says so: no .vdb has
/// it.
inline bool holdsUnsigned(const Volume& volume) {
    return volume.source && volume.type == "uint64" && volume.source->grid.as<openvdb::Int64Tree>();
}

}  // namespace deltasplat
