// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/delta/delta_format.h"
#include "formats/vdb/grid_codes.h"

namespace deltasplat {

/// Turns a delta grid of exact values into the volume that its source would be read as.
/// @param volume  has its name, transform and origin, and is given the rest
/// @throw as readDeltaGrid
void readExactDeltas(TreeGrid& deltas, const DeltaHeader& header, const VdbMetadata& fileMetadata,
                     const GridCodesOptions& options, Volume& volume);

}  // namespace deltasplat
