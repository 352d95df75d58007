// SPDX-License-Identifier: Apache-2.0
// For programs that have OpenVDB themselves: the one header that includes it.
#pragma once

#include <openvdb/openvdb.h>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// Makes a volume of a scalar grid (float, double, int32, int64, bool or mask) with a linear
/// transform: what readVolume would make of a .vdb file of it. The grid is not changed; where
/// `options` ask for the source to be kept it is shared, unless a level set has to become fog or
/// NaN may have to be replaced, of which there is a copy.
/// @param options  levelSetToFog, levelSetSurface, nanValue, bits, relativeError, keepSource,
///                 keepInexact
/// @throw Error(kUsage) without a grid, or for one that holds the differences of a delta grid;
///        Error(kInput) for another type or transform, or for NaN and infinities that nothing
///        replaces
Volume makeVolume(const openvdb::GridBase::ConstPtr& grid, const ReadOptions& options = {},
                  const Listener& listener = {});

/// Returns the OpenVDB grid that a volume is. Of a volume that was one, and whose source is kept,
/// that is the grid that makeVolume was given, or else one with the source's own tree. Otherwise: a
/// volume that has a background gets a grid of its own type if OpenVDB has it, another one a float
/// grid if floats hold every value, else int32 if that does, else double; with name, class,
/// transform and metadata (of OpenVDB's own types). Tiles stay tiles, and every active voxel is
/// active. Values come from Volume::source, or if there is none from the codes. Deterministic.
/// @throw Error(kUsage) for a volume without voxels (Volume::codes); Error(kFailed) if OpenVDB
///        cannot hold the volume's transform
openvdb::GridBase::ConstPtr makeGrid(const Volume& volume);

}  // namespace deltasplat
