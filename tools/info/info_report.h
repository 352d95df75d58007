// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/delta/stamp_counts.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// What `info` says about one grid.
struct GridReport {
    Volume volume;                      ///< without its codes
    VolumeEntry entry;                  ///< which series it is, of how many volumes
    std::int64_t volumeIndex = 0;       ///< which of these volumes
    std::array<SliceCounts, 3> counts;  ///< along x, y and z, every active voxel visible
    std::optional<double> backgroundGuess;
    /// Which voxels the stamps below take for visible: "not clear under ct", ...
    std::string visible;
    std::array<StampCounts, 3> stamps;  ///< predicted for a view along x, y and z
    /// What a plot shows along x, y and z, visible as for the stamps (see SlicePlot); empty if not
    /// asked for.
    std::array<std::vector<SliceCounts>, 3> columns;
};

struct FileReport {
    std::string file;
    std::vector<GridReport> grids;
    std::vector<std::string> others;  ///< grids that are not scalar, as "velocity (vec3s)"
    MediumGrids medium;               ///< of a .vdb, what `auto` means among its grids
};

/// Returns how alike consecutive slices are, 1 - deltas / voxels; 1 for an empty grid.
double comparability(const GridReport& report, int axis);

/// Returns one JSON object, `{"files":[{"file":...,"emission_grid":...,"color_grid":...,
/// "grids":[...]}]}`, with a line end.
/// @param transferFunction  its file, or empty
/// @param isSequence        whether `"sequence"` (sequenceJson) follows
std::string jsonText(const std::vector<FileReport>& reports, const std::string& transferFunction,
                     bool isSequence);

/// Returns one block of aligned lines for each grid, and names the grids that are not scalar.
std::string plainText(const std::vector<FileReport>& reports);

}  // namespace deltasplat
