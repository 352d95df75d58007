// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "ingest/codes/code_tree.h"

namespace deltasplat {

/// Returns how many active voxels have each code, [65536]. Multi-threaded.
std::vector<std::uint64_t> histogramOf(const CodeTree::Tree& tree);

/// Returns the histogram of a volume before it was cut: what is cut off counts as well, so that
/// colours do not change by cutting.
inline std::vector<std::uint64_t> uncutHistogram(const Volume& volume) {
    return volume.uncut ? histogramOf(volume.uncut->tree()) : volume.histogram;
}

/// Returns the box of the active voxels, whose indices must fit.
IndexBox activeBox(const CodeTree::Tree& tree);

}  // namespace deltasplat
