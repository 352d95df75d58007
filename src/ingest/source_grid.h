// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/MetaMap.h>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// A volume's own grid, in its own value type: every value, inactive ones included, background,
/// transform, class and metadata.
struct SourceGrid {
    openvdb::GridBase::ConstPtr grid;
    openvdb::MetaMap fileMetadata{};  ///< of the .vdb file, not of the grid
};

}  // namespace deltasplat
