// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Turns a delta grid into the volume that it was made from. Level sets become fog as
/// `options.levelSetToFog` says.
/// @param grid  as isDeltaGrid says; active tiles become voxels
/// @throw Error(kInput) if the grid is damaged; as readVolume
Volume readDeltaGrid(openvdb::GridBase& grid, const openvdb::MetaMap::ConstPtr& fileMetadata,
                     const std::string& where, const ReadOptions& options,
                     const Listener& listener);

}  // namespace deltasplat
