// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// What `info` says about one grid.
struct GridReport {
    Volume volume;                      ///< without its codes
    std::array<SliceCounts, 3> counts;  ///< along x, y and z
};

struct FileReport {
    std::string file;
    std::vector<GridReport> grids;
    std::vector<std::string> others;  ///< grids that are not scalar, as "velocity (vec3s)"
};

/// Returns how alike consecutive slices are, 1 - deltas / voxels; 1 for an empty grid.
double comparability(const GridReport& report, int axis);

/// Returns one JSON object, `{"files":[{"file":...,"grids":[...]}]}`, with a line end.
std::string jsonText(const std::vector<FileReport>& reports);

/// Returns one block of aligned lines for each grid, and names the grids that are not scalar.
std::string plainText(const std::vector<FileReport>& reports);

}  // namespace deltasplat
