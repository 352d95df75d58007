// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

#include "formats/delta/decode_deltas.h"
#include "formats/delta/delta_format.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Restores a .vdb grid from the deltas of its codes. `deltas` has the source's metadata.
TreeGrid restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex);

/// Does the same from exact values; a source that was no .vdb gives a grid without metadata.
TreeGrid restoreGrid(const DeltaHeader& header, const DecodedValues& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex);

/// @throw Error(kInput) if the number of active voxels is not the header's
void requireActiveCount(std::uint64_t active, const DeltaHeader& header, const std::string& where);

}  // namespace deltasplat
