// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deltasplat/synth/write_analytic.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Samples a volume as writeAnalytic writes it to a `.vdb`.
/// @throw Error(kFailed) for more than memory holds; whatever `listener.progress` throws
std::vector<TreeGrid> sampleGrids(const AnalyticVolume& volume, const AnalyticFileOptions& options,
                                  const Listener& listener);

}  // namespace deltasplat
