// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deltasplat/ingest/list_grids.h"

namespace deltasplat {

struct FileListing {
    std::string file;
    std::vector<VolumeEntry> volumes;
};

/// Returns a line for each volume, columns aligned within a file, under a line with the file's
/// name.
std::string plainText(const std::vector<FileListing>& files);

/// Returns one JSON object, `{"files":[{"file":...,"grids":[...]}]}`, with a line end.
std::string jsonText(const std::vector<FileListing>& files);

}  // namespace deltasplat
