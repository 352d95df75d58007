// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/code_tree.h"
#include "volume/cut_region.h"

namespace deltasplat {

/// Returns a tree of the active voxels in the region; splits tiles at its border. Multi-threaded.
/// @throw Error(kFailed) if memory is too small
std::shared_ptr<CodeTree> keepVoxels(const CodeTree& codes, const CutRegion& region);

}  // namespace deltasplat
