// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// A volume's own grid, in its own value type: every value, inactive ones included, background,
/// transform, class and metadata.
struct SourceGrid {
    openvdb::GridBase::ConstPtr grid;
    /// .vdb: the metadata of the file itself, the same for all of its grids; otherwise null.
    openvdb::MetaMap::ConstPtr fileMetadata = nullptr;
};

}  // namespace deltasplat
