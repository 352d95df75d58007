// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "optics/voxel_painter.h"

// The painters that makePainter (voxel_painter.h) chooses from, of volumes that are not empty.

namespace deltasplat {

/// Returns who colours voxels by where they are.
/// @param colorBy  not kValue
std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy);

/// Returns who knows how voxels lie, so that they reflect lights in the colours of their classes.
std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading);

}  // namespace deltasplat
