// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <glm/mat4x4.hpp>
#include <string>

#include "ingest/delta/decode_deltas.h"
#include "ingest/delta/delta_format.h"

namespace deltasplat {

/// Makes the grid that deltas of codes were made from, a grid of a .vdb.
/// @param deltas  has the source's metadata
openvdb::GridBase::Ptr restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded,
                                   const openvdb::GridBase& deltas,
                                   const glm::dmat4& worldFromIndex);

/// The same from values that stand for themselves; a grid without metadata if the source was no
/// .vdb.
openvdb::GridBase::Ptr restoreGrid(const DeltaHeader& header, const DecodedValues& decoded,
                                   const openvdb::GridBase& deltas,
                                   const glm::dmat4& worldFromIndex);

/// @throw Error(kInput) unless there are so many active voxels as the header says
void requireActiveCount(std::uint64_t active, const DeltaHeader& header, const std::string& where);

}  // namespace deltasplat
