// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "deltasplat/ingest/read_volume.h"
#include "formats/vdb/vdb_file.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Turns a delta grid into its original volume. Level sets become fog if `options.levelSetToFog`.
/// @param grid  a delta grid; active tiles become voxels
/// @throw Error(kInput) if the grid is damaged; as readVolume
VolumeData readDeltaGrid(TreeGrid& grid, const VdbMetadata& fileMetadata, const std::string& where,
                         const ReadOptions& options, const Listener& listener);

/// Reads a packed delta grid of a file as the same volume, with blocks along its slices as codes
/// (decodeBlocks), if `options` need no OpenVDB grid.
/// @return nothing for other grids, unsound grids and other options
/// @throw as decodeBlocks
std::optional<VolumeData> readDeltaBlocks(const VdbFile& file, const VdbGrid& grid,
                                          const std::string& where, const ReadOptions& options,
                                          const Listener& listener);

}  // namespace deltasplat
