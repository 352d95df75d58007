// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "deltasplat/convert/write_volume.h"

namespace deltasplat {

/// Writes volumes as the grids of one .vdb; as writeVolumes.
WriteReport writeGrids(const std::filesystem::path& file, std::vector<Volume> volumes,
                       const WriteOptions& options, const Listener& listener);

}  // namespace deltasplat
