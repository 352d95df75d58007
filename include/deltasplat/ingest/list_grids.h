// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Names of the grids of a .vdb file, in file order.
struct GridList {
    std::vector<std::string> scalar;  ///< as ReadOptions::gridName takes them
    std::string preferred;            ///< of the scalar ones, that read by default; or empty
    std::vector<std::string> others;  ///< with their types, as "velocity (vec3s)"
    std::vector<std::string> deltas;  ///< of the scalar ones, those that are delta grids
    /// All that are no delta grids, with their types.
    std::vector<std::string> ordinary;
};

/// Lists the grids of a .vdb file without reading their voxels.
/// @throw Error(kInput) if the file is missing or no whole .vdb file
GridList listGrids(const std::filesystem::path& file);

/// What the headers of a file say about one volume in it.
struct VolumeEntry {
    std::string name;             ///< as ReadOptions::gridName takes it, where there are grids
    std::string type;             ///< as Volume::type; of a delta grid, that of its source
    std::string gridClass;        ///< as Volume::gridClass; "" where none is said
    std::optional<IndexBox> box;  ///< of its active voxels; empty optional where it is not said
    bool scalar = true;           ///< whether it can be read
    bool delta = false;           ///< whether it is a delta grid
    bool preferred = false;       ///< whether it is the one read by default
};

/// Lists what is in a file that readVolume reads, voxels unread.
/// @throw as readVolume, as far as headers go
std::vector<VolumeEntry> listVolumes(const std::filesystem::path& file,
                                     const ReadOptions& options = {},
                                     const Listener& listener = {});

}  // namespace deltasplat
