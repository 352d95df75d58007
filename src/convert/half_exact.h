// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/volume.h"
#include "ingest/grids/tree_grid.h"

namespace deltasplat {

/// Returns whether a grid of real values, stored in half precision by writeVdb, reads back with
/// every value as it is, inactive ones included; false for grids of other types.
/// @param volume  null, or one whose active values are those of the grid, or more: where its codes
///                are exact, its histogram says which there are
bool survivesHalf(const TreeGrid& grid, const Volume* volume = nullptr);

/// Returns the same of a grid that codes become.
/// @param volume  whose histogram says which codes there are
/// @param type    of the grid: "float", "int32", ...
bool survivesHalf(const Volume& volume, const std::string& type, double background);

}  // namespace deltasplat
