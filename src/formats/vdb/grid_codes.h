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
    const Listener& listener;  ///< hears where the result deviates from the file
    std::string where;         ///< file and grid, for messages
    std::string type;          ///< value type as the file stores it: "half", "float", ...
    const ReadOptions& reading;
};

/// Turns a scalar grid into codes and fills in all of `volume` but its name and transform. May
/// change the grid. A level set without a band (background not above 0) cannot become fog: the
/// level set is kept, with a warning. Active tiles stay tiles at their level. Deterministic.
/// @throw NotFinite for unreplaced NaN or infinity; Error(kInput) if voxels lie too far apart
void fillFromGrid(TreeGrid& grid, const GridCodesOptions& options, VolumeData& volume);

/// Does the same with a grid whose leaf values are still in the file. Level sets stay level sets.
/// @return false if the grid must be read as a whole: non-finite values, or no half among halves
/// @throw Error(kInput) also if values cannot be unpacked or do not belong to the topology's voxels
bool fillFromLeaves(const VdbValues& values, const GridCodesOptions& options, VolumeData& volume);

/// @param active  not empty
/// @throw Error(kInput) if the voxels lie too far apart
IndexBox boxOfVoxels(const openvdb::CoordBBox& active, const std::string& where);

/// Fills in background, type and class of a volume from its grid.
void describeGrid(double background, const VdbMetadata& metadata, const GridCodesOptions& options,
                  VolumeData& volume);

}  // namespace deltasplat
