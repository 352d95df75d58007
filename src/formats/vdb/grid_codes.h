// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "formats/vdb/vdb_file.h"
#include "volume/tree_grid.h"

namespace deltasplat {

struct GridCodesOptions {
    const Listener& listener;  ///< hears of what was taken otherwise than the file says
    std::string where;         ///< file and grid, for messages
    std::string type;          ///< value type as the file stores it: "half", "float", ...
    const ReadOptions& reading;
};

/// Turns a scalar grid into codes and fills in everything of `volume` but its name and transform.
/// The grid may be changed on the way. A level set
/// without a band (background not above 0) cannot become fog: it is kept, with a warning. Active
/// tiles stay tiles at their level. Deterministic.
/// @throw NotFinite if values are NaN or infinite and not replaced; Error(kInput) if they lie too
///        far apart
void fillFromGrid(TreeGrid& grid, const GridCodesOptions& options, Volume& volume);

/// Does the same with a grid whose leaves' values are still in their file. Returns false if a value
/// is not finite, or a tile's is no half where leaves have halves: then the grid is to be read as a
/// whole. Level sets stay what they are.
/// @throw Error(kInput) also if values cannot be unpacked, or are of other voxels than the topology
///        says
bool fillFromLeaves(const VdbValues& values, const GridCodesOptions& options, Volume& volume);

/// Returns the box of the active voxels.
/// @param active  not empty
/// @throw Error(kInput) if they lie too far apart
IndexBox boxOfVoxels(const openvdb::CoordBBox& active, const std::string& where);

/// Fills in what a volume has of a grid beside voxels, name and transform.
void describeGrid(double background, const VdbMetadata& metadata, const GridCodesOptions& options,
                  Volume& volume);

}  // namespace deltasplat
