// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "info/info_report.h"

namespace deltasplat {

/// Returns what the grids of all files have in common, by their names: an array of `{"name",
/// "files", "filled", "range", "world_box", "most_active"}`, the first and the last but one null
/// where there is none.
nlohmann::ordered_json sequenceJson(const std::vector<FileReport>& reports);

/// Returns the same as aligned lines, a block for each grid.
/// @param asked  how many files there should be
std::string sequenceText(const std::vector<FileReport>& reports, std::size_t asked);

}  // namespace deltasplat
