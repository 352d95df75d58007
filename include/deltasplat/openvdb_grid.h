// SPDX-License-Identifier: Apache-2.0
// For programs that have OpenVDB themselves: the one header that includes it.
#pragma once

#include <openvdb/openvdb.h>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// Makes a volume of a scalar grid (float, double, int32, int64, bool or mask) with a linear
/// transform, as readVolume would from a .vdb file of the grid. The grid is not changed. If
/// `options` keep the source, the volume shares the grid; it copies a level set that has to become
/// fog, or a grid in which NaN may have to be replaced.
/// @param options  levelSetToFog, levelSetSurface, nanValue, bits, relativeError, keepSource,
///                 keepInexact
/// @throw Error(kUsage) without a grid, or for the differences of a delta grid; Error(kInput) for
///        another type or transform, or for NaN and infinities without a replacement
Volume makeVolume(const openvdb::GridBase::ConstPtr& grid, const ReadOptions& options = {},
                  const Listener& listener = {});

/// Returns a volume as an OpenVDB grid. A volume that was a grid and keeps its source gives the
/// grid that makeVolume got, or a grid with the source's own tree. Any other volume gets a new
/// grid: of the volume's own type if it has a background and OpenVDB has the type; otherwise float
/// if floats hold every value, else int32 if int32 does, else double. Name, class, transform and
/// metadata (of OpenVDB's own types) are set. Tiles stay tiles, and every active voxel is active.
/// Values come from Volume::source, or from the codes without a source. Deterministic.
/// @throw Error(kUsage) without Volume::codes; Error(kFailed) if OpenVDB has no such transform
openvdb::GridBase::ConstPtr makeGrid(const Volume& volume);

}  // namespace deltasplat
