// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "optics/voxel_painter.h"

// The painters that makePainter (voxel_painter.h) chooses from, of volumes that are not empty.

namespace deltasplat {

/// Returns who colours voxels by where they are.
/// @param colorBy  not kValue
std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy);

/// Returns who knows how voxels lie, so that they reflect lights in the colours of their classes.
std::unique_ptr<const VoxelPainter> makeShadingPainter(const Volume& volume,
                                                       const Shading& shading);

/// Returns who draws a surface. Voxels are of the class that is seen by the share of them that lies
/// inside.
/// @param shading  empty: in one colour from everywhere
std::unique_ptr<const VoxelPainter> makeSurfacePainter(const Volume& volume, const Surface& surface,
                                                       const std::optional<Shading>& shading);

/// Returns who lights fog. Sweeps the volume from each light on.
/// @param optics  with scattering
/// @throw Error(kFailed) if there is not enough memory
std::unique_ptr<const VoxelPainter> makeScatterPainter(const Volume& volume, const Optics& optics);

/// Returns who makes voxels less opaque by how much values change there.
/// @param factors  Optics::gradientOpacity, not empty
/// @param inner    who paints them otherwise; null: they look as their classes do
std::unique_ptr<const VoxelPainter> makeFadingPainter(const Volume& volume,
                                                      const std::vector<glm::dvec2>& factors,
                                                      std::unique_ptr<const VoxelPainter> inner);

/// Returns who adds the other parts of a medium, and colours of grids, to a volume, which may be
/// empty, and lights it as makeScatterPainter does, if that is asked for.
std::unique_ptr<const VoxelPainter> makeMediumPainter(const Volume& volume, const Optics& optics);

}  // namespace deltasplat
