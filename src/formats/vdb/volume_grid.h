// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/volume.h"
#include "formats/vdb/written_grid.h"
#include "volume/tree_grid.h"

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

/// Returns the volume with lengths in a unit in which OpenVDB holds them, where its own makes
/// voxels too small and a unit is known; else as it is.
Volume withHoldableUnit(Volume volume);

/// Returns the grid that a volume is. The grid of a .vdb source is that source itself.
/// Otherwise: a volume that has a background (it was a .vdb once) gets a grid of its own type
/// again, another one a float grid if floats hold every value, else int32 if that does, else
/// double; with name, class, transform, creator and the metadata of grid_metadata.h. Tiles stay
/// tiles, and every active voxel is active. Values come from Volume::source, or if there is none
/// from the codes. Whether it will be stored in half precision is left open. Deterministic.
/// @throw Error(kFailed) if OpenVDB cannot hold the volume's transform
TreeGrid gridOf(const Volume& volume);

/// Returns the value type of that grid: "float", "mask", ...
std::string gridTypeOf(const Volume& volume);

/// Returns what is written of codes, without a tree of values: the grid that gridOf makes of a
/// volume that has no source, but for what inactive voxels hold.
/// @param type  as gridTypeOf
/// @throw as gridOf
WrittenGrid writtenCodes(const Volume& volume, const std::string& type, double background);

}  // namespace deltasplat
