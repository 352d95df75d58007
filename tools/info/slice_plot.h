// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "drawing/drawing.h"

namespace deltasplat {

/// What one row of the picture shows.
struct SlicePlot {
    std::string title;
    std::string visible;  ///< which voxels are called visible: "visible: not clear under ct"
    IndexBox box;
    /// Along x, y and z: the counts of slicesPerColumn slices each; none for an empty volume.
    std::array<std::vector<SliceCounts>, 3> columns;
};

/// Returns how many of a volume's slices share a column, so that the columns fit side by side.
int slicesPerColumn(int sliceCount);

/// Draws, for each plot, three panels side by side: along x, y and z, what share of each slice's
/// voxels is visible, and what share changes from the slice before. The panels of a row have one
/// scale. A column shows the mean of its slices.
Drawing drawSlicePlots(const std::vector<SlicePlot>& plots);

}  // namespace deltasplat
