// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "deltasplat/progress.h"
#include "formats/delta/delta_format.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// What the deltas of a volume add up to, in the volume's own index space.
struct DecodedDeltas {
    std::shared_ptr<CodeTree> codes = std::make_shared<CodeTree>();
    /// Active where the volume has inactive voxels with a value of their own; holds the value's
    /// number in DeltaHeader::inactiveValues.
    std::shared_ptr<CodeTree> inactive = std::make_shared<CodeTree>();
};

/// The same of a source whose values stand for themselves (DeltaHeader::exact).
struct DecodedValues {
    /// Of the type DeltaHeader::exact, with the source's background; 0 if it has none.
    std::shared_ptr<openvdb::TreeBase> values;
    std::shared_ptr<CodeTree> inactive = std::make_shared<CodeTree>();  ///< as above
};

/// Adds up the deltas along the slices, slab by slab. Active tiles of `grid` become voxels.
/// Multi-threaded; deterministic.
/// @param grid  as isDeltaGrid says, of codes
/// @throw Error(kInput) if the deltas contradict the header or lead outside of the code book, or if
///        the header alone asks for more than memory holds; Error(kFailed) if the codes do not fit
///        into memory, whatever the listener throws
DecodedDeltas decodeDeltas(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener);

/// As decodeDeltas, of a grid of exact values.
DecodedValues decodeValues(TreeGrid& grid, const DeltaHeader& header, const std::string& where,
                           const Listener& listener);

}  // namespace deltasplat
