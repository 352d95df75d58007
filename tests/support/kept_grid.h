// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/ingest/volume.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat::testing {

/// Returns the grid that a volume keeps as OpenVDB's, of the same tree; null if it is of another
/// type.
template <typename Grid>
typename Grid::Ptr keptGrid(const Volume& volume) {
    return openvdb::gridPtrCast<Grid>(toOpenVdb(volume.source()->grid));
}

}  // namespace deltasplat::testing
