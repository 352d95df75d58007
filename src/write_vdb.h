// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/MetaMap.h>

#include <filesystem>

#include "deltasplat/progress.h"

namespace deltasplat {

/// Writes grids into one `.vdb`: Blosc and active-mask compression, grid offsets, statistics in the
/// metadata, as openvdb::io::File does, with two differences. The file appears only when it is
/// whole (io::File does not notice a full disk). And its 128-bit tag, random otherwise, is made
/// from the content, so that the same grids give the same bytes.
/// @throw Error(kOutput) if it cannot be written; whatever `listener.progress` throws
void writeVdb(const std::filesystem::path& file, const openvdb::GridCPtrVec& grids,
              const openvdb::MetaMap& fileMetadata = {}, const Listener& listener = {});

}  // namespace deltasplat
