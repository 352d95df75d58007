// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/vdb/grid_codes.h"

namespace deltasplat {

/// Makes a volume of a scalar grid: all of it but its name, and Volume::source where `options` ask
/// for it, which then is this grid. The grid may be changed on the way.
/// @param fileMetadata  goes into the source
/// @throw as fillFromGrid; Error(kInput) for a transform that is not linear
Volume volumeOfGrid(TreeGrid grid, const GridCodesOptions& options,
                    const VdbMetadata& fileMetadata = {});

/// Makes the lengths of a patient's space millimetres, as Volume::lengthUnit has it.
/// @throw Error(kInput) if they give voxels no place
void settleUnit(const std::string& where, Volume& volume);

/// Returns a volume that has its place, and no voxels.
Volume placedVolume(const openvdb::math::MapBase& map, const VdbMetadata& metadata,
                    const GridCodesOptions& options);

/// A background of NaN or infinity is taken as what replaces NaN, or 0, with a warning; there is
/// one for a volume without active voxels as well.
void settleEmpty(Volume& volume, const GridCodesOptions& options);

/// Does the same with a grid whose leaves' values are still in their file; nothing where
/// fillFromLeaves() says so. There is no source.
/// @throw as volumeOfGrid
std::optional<Volume> volumeOfLeaves(const VdbValues& values, const GridCodesOptions& options);

}  // namespace deltasplat
