// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <array>

namespace deltasplat {

/// Returns the names of the metadata that OpenVDB's writers note beside a grid, and set anew
/// whenever they write it.
inline std::array<const char*, 6> fileMetadata() {
    using openvdb::GridBase;
    return {GridBase::META_FILE_BBOX_MIN,    GridBase::META_FILE_BBOX_MAX,
            GridBase::META_FILE_COMPRESSION, GridBase::META_FILE_MEM_BYTES,
            GridBase::META_FILE_VOXEL_COUNT, GridBase::META_FILE_DELAYED_LOAD};
}

}  // namespace deltasplat
