// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "volume/code_math.h"

namespace deltasplat {

/// Rows of 8x8 voxels of slices that lie one behind the other, as SliceJoiner::join takes them.
struct JoinedRows {
    const ClassIndex* const* slices;  ///< [count]: the first voxel in each
    std::size_t count;
    std::size_t pitch;  ///< from row to row
};

}  // namespace deltasplat
