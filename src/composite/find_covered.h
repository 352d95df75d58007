// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "composite/layer.h"
#include "splat/covered_cells.h"

namespace deltasplat {

/// Adds the cells in which a layer is opaque everywhere, its opacity 1 to the last bit: whatever is
/// put behind it there changes no bit, for it is multiplied by 0.
/// @return whether there are any that were not covered
bool addCovered(const Layer& layer, CoveredCells& cells);

}  // namespace deltasplat
