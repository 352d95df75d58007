// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Hands over the scalar grids of a file one after the other and names those that are left out in
/// one warning; returns whether there were none.
bool forEachScalarGrid(const std::filesystem::path& input, const ReadOptions& options,
                       const std::function<void(Volume)>& use, const Listener& listener);

}  // namespace deltasplat
