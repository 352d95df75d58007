// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ingest/delta/delta_format.h"
#include "ingest/grids/tree_types.h"

namespace deltasplat {

/// Returns the words that unpackDeltas reads, of DeltaHeader::kPackedVersion; none if there are no
/// deltas. Multi-threaded;
/// deterministic.
/// @param deltas  without sign, in (slice, u, v) order in leaves, of type int32 or int64 as
///                versions 3 and 4 have them; within the header's box
std::vector<std::uint64_t> streamOf(const openvdb::TreeBase& deltas, const DeltaHeader& header);

}  // namespace deltasplat
