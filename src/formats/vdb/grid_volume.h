// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/vdb/grid_codes.h"

namespace deltasplat {

/// Makes a volume without name of a grid, which becomes its source if `options` ask. May change it.
/// @param fileMetadata  goes into the source
/// @throw as fillFromGrid; Error(kInput) for a transform that is not linear
VolumeData volumeOfGrid(TreeGrid grid, const GridCodesOptions& options,
                        const VdbMetadata& fileMetadata = {});

/// Converts the lengths of a patient's space to millimetres, as Volume::lengthUnit requires.
/// @throw Error(kInput) if the scaled transform cannot place voxels
void settleUnit(const std::string& where, VolumeData& volume);

/// Returns a volume that has its place but no voxels.
VolumeData placedVolume(const openvdb::math::MapBase& map, const VdbMetadata& metadata,
                        const GridCodesOptions& options);

/// Replaces a non-finite background by `nanValue` or 0, and warns. Warns of empty volumes, too.
void settleEmpty(VolumeData& volume, const GridCodesOptions& options);

/// Makes a volume without source from leaf values in a file; nothing if fillFromLeaves() fails.
/// @throw as volumeOfGrid
std::optional<VolumeData> volumeOfLeaves(const VdbValues& values, const GridCodesOptions& options);

}  // namespace deltasplat
