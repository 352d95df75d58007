// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Hands over the scalar grids of a file one after the other, names those that are left out in one
/// warning, and returns their names: "Cd (vec3s)"; "" if there were none.
std::string forEachScalarGrid(const std::filesystem::path& input, const ReadOptions& options,
                              const std::function<void(Volume)>& use, const Listener& listener);

}  // namespace deltasplat
