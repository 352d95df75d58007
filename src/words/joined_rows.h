// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "volume/code_math.h"

namespace deltasplat {

/// Rows of 8x8 voxels in consecutive slices, as for SliceJoiner::join.
struct JoinedRows {
    const ClassIndex* const* slices;  ///< [count]: first voxel of each slice
    std::size_t count;
    std::size_t pitch;  ///< distance of rows
};

}  // namespace deltasplat
