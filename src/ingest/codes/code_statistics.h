// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ingest/codes/code_tree.h"

namespace deltasplat {

/// Returns how many active voxels have each code, [65536]. Multi-threaded.
std::vector<std::uint64_t> histogramOf(const CodeTree::Tree& tree);

/// Returns the box of the active voxels, whose indices must fit.
IndexBox activeBox(const CodeTree::Tree& tree);

}  // namespace deltasplat
