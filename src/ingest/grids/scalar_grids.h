// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

namespace deltasplat {

/// The grids that are volumes here, for openvdb::GridBase::apply.
using ScalarGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid>;

}  // namespace deltasplat
