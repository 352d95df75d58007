// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "formats/vdb/vdb_file.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Whether each voxel of a grid has three numbers.
bool isVector(const VdbGrid& grid);

/// The part of a vector grid that a name such as "Cd.x" asks for: 0 for .x, 1 for .y, 2 for .z.
struct VectorPart {
    std::string grid;
    int axis;
};
std::optional<VectorPart> vectorPartOf(const std::string& name);

/// Returns one part of a vector grid with its voxels, transform and metadata. Multi-threaded.
/// @param grid  isVector()
TreeGrid gridOfPart(const TreeGrid& grid, int axis);

}  // namespace deltasplat
