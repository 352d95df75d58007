// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include "ingest/delta/delta_format.h"

namespace deltasplat::testing {

/// Makes the metadata of a grid of OpenVDB's say what a header says.
inline void putHeader(const DeltaHeader& header, openvdb::GridBase& grid) {
    VdbMetadata metadata(grid);
    putDeltaHeader(header, metadata);
    const openvdb::MetaMap::Ptr all = metadata.toMetaMap("test");
    grid.clearMetadata();
    grid.insertMeta(*all);
}

}  // namespace deltasplat::testing
