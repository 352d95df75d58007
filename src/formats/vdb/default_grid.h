// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/vdb/vdb_file.h"

namespace deltasplat {

/// Whether simulation programs give this name to fields that only help their solvers or their own
/// display, and that fill the whole domain: "phi_obstacle", "flags", "shadow", "x_noise", ...
bool isHelperName(const std::string& gridName);

/// Returns the grid that is read where none is asked for, or nullptr if there are no numbers: the
/// one named `density`, else the first fog volume, else the first of another class, else `phi`;
/// helpers only where there is nothing else. It may be one that cannot be read: who reads it says
/// so, since the next one would be another thing than is meant.
/// @throw Error(kInput) if a grid's metadata, which have its class, are damaged
const VdbGrid* defaultGrid(const VdbFile& file);
/// The same for lists, which leave it to who reads the grid to say what is damaged: then nullptr.
const VdbGrid* toldDefaultGrid(const VdbFile& file);

}  // namespace deltasplat
