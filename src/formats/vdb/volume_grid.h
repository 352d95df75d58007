// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/volume.h"
#include "formats/vdb/written_grid.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Whether writeVdb can store a grid of real values as halves without changing any value, inactive
/// ones included; false for grids of other types.
/// @param volume  null, or has at least the grid's active values: exact codes need no second look
bool survivesHalf(const TreeGrid& grid, const Volume* volume = nullptr);

/// Does the same for the grid that codes will become.
/// @param volume  its histogram tells the codes in use
/// @param type    of the grid: "float", "int32", ...
bool survivesHalf(const Volume& volume, const std::string& type, double background);

/// Returns the volume in a finer length unit if its voxels are too small for OpenVDB and one helps.
Volume withHoldableUnit(Volume volume);

/// Returns a volume as a grid. The grid of a .vdb source is that source itself. Otherwise a volume
/// with a background (a former .vdb) keeps its type. Other volumes become float if floats hold
/// every value, else int32, else double, else int64. The grid gets name, class, transform, creator
/// and the metadata of grid_metadata.h. Tiles stay tiles; every active voxel is active. Values come
/// from Volume::source, else from the codes. Half precision is decided later. Deterministic.
/// @throw Error(kFailed) if OpenVDB cannot hold the volume's transform
TreeGrid gridOf(const Volume& volume);

/// Returns the value type of gridOf(): "float", "mask", ...
std::string gridTypeOf(const Volume& volume);

/// Returns codes ready for writing, without a tree of values: the grid of gridOf() for a volume
/// without source, except that inactive voxels hold `background`.
/// @param type  as gridTypeOf
/// @throw as gridOf
WrittenGrid writtenCodes(const Volume& volume, const std::string& type, double background);

}  // namespace deltasplat
