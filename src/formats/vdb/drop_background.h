// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/volume.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Returns the most frequent active value of a volume, the smallest of several, or 0 without any.
/// If the code book is inexact and a source exists, only values of the fullest code compete.
double mostFrequentValue(const Volume& volume);

/// Returns a copy of a scalar grid with background `value`. Active voxels of this value become
/// inactive; inactive voxels of the old background become `value`. All others stay unchanged.
TreeGrid dropBackground(const TreeGrid& grid, double value);

/// Does the same with the codes of a volume without background, and with its histogram.
/// @param type  of the grid to come: codes are dropped whose value in this type is `value`
void dropBackground(Volume& volume, double value, const std::string& type);

}  // namespace deltasplat
