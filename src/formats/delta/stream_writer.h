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

/// Which codes deltas add up to: what a stream says of itself, so that a reader who wants some
/// codes need not unpack all of it.
struct StreamCodes {
    std::vector<std::pair<Code, Code>> ranges;  ///< of each column's active voxels
    std::vector<std::uint64_t> histogram;       ///< [kCodeCount], of all active voxels
    IndexBox active;                            ///< of them, in (slice, u, v) order

    /// Write them as readStreamIndex reads them.
    void putRange(std::size_t column, BitWriter& out) const;
    void putHistogram(BitWriter& out) const;
    /// @param box  of the grid, in (slice, u, v) order
    void putBox(const IndexBox& box, BitWriter& out) const;
};

/// Adds deltas up. Multi-threaded; deterministic.
/// @param leaves  of deltas without sign, column by column (one slab, u and v), in the order of
///                slices
/// @param begins  of columns, and the end
/// @return nothing of values that stand for themselves, or if inactive voxels have others than the
///         background
std::optional<StreamCodes> streamCodes(
    const std::vector<const openvdb::Int32Tree::LeafNodeType*>& leaves,
    const std::vector<std::size_t>& begins, const DeltaHeader& header);

/// Returns the words that unpackDeltas reads, of DeltaHeader::kPackedVersion; none if there are no
/// deltas. Multi-threaded;
/// deterministic.
/// @param deltas  without sign, in (slice, u, v) order in leaves, of type int32 or int64 as
///                versions 3 and 4 have them; within the header's box
std::vector<std::uint64_t> streamOf(const openvdb::TreeBase& deltas, const DeltaHeader& header);

}  // namespace deltasplat
