// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Maps.h>

#include <memory>
#include <string>

#include "ingest/grids/tree_grid.h"
#include "ingest/vdb/vdb_metadata.h"
#include "vdb/written_tree.h"

namespace deltasplat {

/// A grid on its way into a .vdb file.
struct WrittenGrid {
    std::string name;
    VdbMetadata metadata;  ///< what is noted anew whenever a file is written does not count
    openvdb::math::MapBase::ConstPtr map;
    std::shared_ptr<const WrittenTree> tree;
    bool packsNotes = true;  ///< whether what is noted of leaves' sizes is packed, as OpenVDB does

    /// Whether the metadata say that real values are stored as halves.
    bool isHalf() const;
};

/// Returns what is written of a scalar grid, or of one of vec3s: itself, which must not change.
/// @throw Error(kFailed) if it is of another type
WrittenGrid writtenGrid(const TreeGrid& grid);

/// Returns what is written of a grid of words (word_tree.h). These do not pack, so the notes of its
/// leaves are not packed either: Blosc takes longer to load than words take to read.
WrittenGrid writtenWords(const TreeGrid& grid);

/// Returns what is written of a grid of deltas, of int32 or int64: active values, on a background
/// of 0, sooner than writtenGrid() has it.
WrittenGrid writtenDeltas(const TreeGrid& grid);

}  // namespace deltasplat
