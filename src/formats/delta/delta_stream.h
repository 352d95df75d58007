// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/progress.h"
#include "formats/delta/delta_columns.h"
#include "volume/tree_grid.h"

namespace deltasplat {

struct DeltaHeader;

/// How the 64 voxels of a slice of a block are written.
enum class SliceForm {
    kAll = 0,   ///< every number
    kMask = 1,  ///< 64 bits that say which numbers are not 0, and those less 1
    kRows = 2   ///< the same with 8 bits for rows and 8 for each row that is not empty
};

/// Deltas as voxels.
struct UnpackedDeltas {
    TreeGrid grid;
    CodesInUse said;  ///< what they are to add up to; without a histogram if that is not known
};

/// Unpacks a delta grid whose voxels are the words of a stream: numbers of few bits, first
/// where its columns are, then the columns; docs/delta-grid.md specifies them.
/// Multi-threaded.
/// @param grid  of type int64
/// @return a grid with the same metadata and transform whose voxels are deltas, as version 4 has
///         them, within the header's box; what they say may contradict the header
/// @throw Error(kInput) if the words have gaps, or the stream ends early or late or says what it
///        cannot; Error(kFailed) if memory does not hold the deltas
UnpackedDeltas unpackDeltas(const TreeGrid& grid, const DeltaHeader& header,
                            const std::string& where, const Listener& listener);
/// Returns how many bits a delta without sign takes at most.
int deltaWidth(const DeltaHeader& header);

}  // namespace deltasplat
