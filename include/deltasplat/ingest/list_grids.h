// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace deltasplat
