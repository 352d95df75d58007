// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ingest/vdb/vdb_file.h"

namespace deltasplat {

/// Whether simulation programs give this name to fields that only help their solvers or their own
/// display, and that fill the whole domain: "phi_obstacle", "flags", "shadow", "x_noise", ...
bool isHelperName(const std::string& gridName);

/// Returns the scalar grid that is read where none is asked for, or nullptr if there is none: the
/// one named `density`, else the first fog volume, else the first of another class; helpers only
/// where there is nothing else.
const VdbGrid* defaultGrid(const VdbFile& file);

}  // namespace deltasplat
