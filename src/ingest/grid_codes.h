// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

struct GridCodesOptions {
    std::string where;               ///< file and grid, for messages
    std::string type;                ///< value type as the file stores it: "half", "float", ...
    bool levelSetToFog = true;       ///< turn level sets into fog volumes
    std::optional<double> nanValue;  ///< replaces NaN and infinities of active values
};

/// Turns a scalar grid into codes and fills in everything of `volume` but its name and transform.
/// The grid may be changed on the way. Active tiles stay tiles at their level. Deterministic.
/// @throw Error(kInput) if values are NaN or infinite and not replaced, or the tree is corrupt
void fillFromGrid(openvdb::GridBase& grid, const GridCodesOptions& options, Volume& volume);

}  // namespace deltasplat
