// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "deltasplat/progress.h"
#include "formats/delta/delta_format.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// The sum of a volume's deltas, in the volume's own index space.
struct DecodedDeltas {
    std::shared_ptr<CodeTree> codes = std::make_shared<CodeTree>();
    /// Active at inactive voxels with other values; holds the index in DeltaHeader::inactiveValues.
    std::shared_ptr<CodeTree> inactive = std::make_shared<CodeTree>();
};

/// The same for a source stored by its values' own bits (DeltaHeader::exact).
struct DecodedValues {
    /// Has type DeltaHeader::exact and the source's background, or 0 if the source has none.
    std::shared_ptr<openvdb::TreeBase> values;
    std::shared_ptr<CodeTree> inactive = std::make_shared<CodeTree>();  ///< as above
};

/// Adds up the deltas along the slices, slab by slab. Active tiles of `grid` become voxels.
/// Multi-threaded; deterministic.
/// @param grid  a delta grid of codes
/// @throw Error(kInput) if deltas contradict the header, leave the code book or claim too much
///        memory; Error(kFailed) if memory is too small; whatever the listener throws
DecodedDeltas decodeDeltas(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener);

/// Does the same for a grid of exact values.
DecodedValues decodeValues(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener);

}  // namespace deltasplat
