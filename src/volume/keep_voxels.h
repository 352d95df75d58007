// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/code_tree.h"
#include "volume/cut_region.h"

namespace deltasplat {

/// Returns a tree of the active voxels that lie in the region. Tiles are split where it ends.
/// Multi-threaded.
/// @throw Error(kFailed) if it does not fit into memory
std::shared_ptr<CodeTree> keepVoxels(const CodeTree& codes, const CutRegion& region);

}  // namespace deltasplat
