// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/volume.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Returns the most frequent active value of a volume, the smallest of several: exactly, if the
/// code book is exact or there is no source; otherwise the most frequent one of those that share
/// the fullest code. 0 for an empty volume.
double mostFrequentValue(const Volume& volume);

/// Returns a copy of a scalar grid with background `value`, in which no active voxel has this
/// value: those, and what held the old background, are inactive and hold the new one. The active
/// voxels keep their values, and so do inactive ones that hold neither.
TreeGrid dropBackground(const TreeGrid& grid, double value);

/// Does the same with the codes of a volume without background, and its histogram.
/// @param type  of the grid that it becomes: codes are dropped whose values are `value` there
void dropBackground(Volume& volume, double value, const std::string& type);

}  // namespace deltasplat
