// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

#include "formats/delta/decode_deltas.h"
#include "formats/delta/delta_format.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Makes the grid that deltas of codes were made from, a grid of a .vdb.
/// @param deltas  has the source's metadata
TreeGrid restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex);

/// The same from values that stand for themselves; a grid without metadata if the source was no
/// .vdb.
TreeGrid restoreGrid(const DeltaHeader& header, const DecodedValues& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex);

/// @throw Error(kInput) unless there are so many active voxels as the header says
void requireActiveCount(std::uint64_t active, const DeltaHeader& header, const std::string& where);

}  // namespace deltasplat
