// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/progress.h"
#include "diff/error_sums.h"
#include "diff/voxel_source.h"

namespace deltasplat {

/// Adds up the errors of all voxels. The order of the additions follows from the volumes alone.
ErrorSums compareTrees(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms,
                       const Listener& listener);

}  // namespace deltasplat
