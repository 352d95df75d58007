// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

namespace deltasplat {

/// Returns whether a grid of real values, stored in half precision by writeVdb, reads back with
/// every value as it is, inactive ones included; false for grids of other types.
bool survivesHalf(const openvdb::GridBase& grid);

}  // namespace deltasplat
