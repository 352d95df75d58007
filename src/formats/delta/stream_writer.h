// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "formats/delta/bit_reader.h"
#include "formats/delta/delta_format.h"
#include "volume/tree_types.h"

namespace deltasplat {

/// The codes that deltas add up to, stated so that readers of some codes can unpack only parts.
struct StreamCodes {
    std::vector<std::pair<Code, Code>> ranges;  ///< per column, of the active voxels
    std::vector<std::uint64_t> histogram;       ///< [kCodeCount], of all active voxels
    IndexBox active;                            ///< of the active voxels, in (slice, u, v) order

    /// Each writes what readStreamIndex reads.
    void putRange(std::size_t column, BitWriter& out) const;
    void putHistogram(BitWriter& out) const;
    /// @param box  of the grid, in (slice, u, v) order
    void putBox(const IndexBox& box, BitWriter& out) const;
};

/// Adds deltas up. Multi-threaded; deterministic.
/// @param leaves  of zigzag deltas, column by column (one slab, u and v), in the order of slices
/// @param begins  of columns, and the end
/// @return nothing for exact values, or if inactive voxels have other values than the background
std::optional<StreamCodes> streamCodes(
    const std::vector<const openvdb::Int32Tree::LeafNodeType*>& leaves,
    const std::vector<std::size_t>& begins, const DeltaHeader& header);

/// Returns the words of packed deltas, none without deltas. Multi-threaded; deterministic.
/// @param deltas  zigzag, int32 or int64, in (slice, u, v) order, within the header's box
std::vector<std::uint64_t> streamOf(const openvdb::TreeBase& deltas, const DeltaHeader& header);

}  // namespace deltasplat
