// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "deltasplat/ingest/read_volume.h"
#include "formats/vdb/vdb_file.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Turns a delta grid into the volume that it was made from. Level sets become fog as
/// `options.levelSetToFog` says.
/// @param grid  as isDeltaGrid says; active tiles become voxels
/// @throw Error(kInput) if the grid is damaged; as readVolume
Volume readDeltaGrid(TreeGrid& grid, const VdbMetadata& fileMetadata, const std::string& where,
                     const ReadOptions& options, const Listener& listener);

/// Reads a packed delta grid of a file as a volume whose codes are blocks along its slices: the
/// same volume, without an OpenVDB grid, where nothing of what is asked for needs one
/// (decodeBlocks).
/// @return nothing where it is another grid, is not sound, or is asked for otherwise
/// @throw as decodeBlocks
std::optional<Volume> readDeltaBlocks(const VdbFile& file, const VdbGrid& grid,
                                      const std::string& where, const ReadOptions& options,
                                      const Listener& listener);

}  // namespace deltasplat
