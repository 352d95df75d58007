// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// What a volume is expected to take in a file, in bytes.
struct DeltaEstimate {
    double plainBytes = 0;  ///< as an ordinary grid (writeVolume)
    double deltaBytes = 0;  ///< as a delta grid (DeltaFile)
    double voxelBytes = 0;  ///< likewise, without DeltaFileOptions::pack
    /// Whether the delta grid, packed or not, is read straight from the file, block by block, for
    /// pictures along its slices.
    bool readsByBlocks = false;
    /// The share of the volume's blocks that was written to find out, above 0 to 1.
    double sampled = 1;
};

/// Writes about a thousand blocks of a volume to nowhere, or all if it has no more, in each form.
/// Of one whose code book is not exact, Volume::source says what it is; what inactive voxels hold
/// is left out where there is none. Multi-threaded; deterministic.
/// @param sliceAxis  of the delta grid, 0 = x, 1 = y, 2 = z: the one with the fewest deltas
/// @return empty for a volume without active voxels, for one with uniform regions of more than
///         128^3 voxels, if the source is missing of one whose code book is not exact, and for
///         one that cannot be written (writeVolume)
std::optional<DeltaEstimate> estimateDeltaFile(const Volume& volume, int sliceAxis);

}  // namespace deltasplat
