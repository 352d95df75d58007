// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// Turns what shines of a medium into point lights, so that fire lights the fog around it
/// (Scattering): blocks of 8x8x8 voxels that glow are cut into groups that lie close together, and
/// each group becomes one light. It has all that the group sends out, stands where that comes from
/// on average, and has the radius within which a ball that glows evenly, as widely spread as the
/// group, lights its middle. Nothing is taken off for what dims the fire on its way to that place.
/// Deterministic, whatever the number of threads.
/// @param volume  at whose voxels the parts are read, and over whose unit distance they glow; may
///                be empty
/// @param optics  with the parts; those that swallow light do not shine
/// @param count   of lights, >= 1
/// @return at most `count` lights, the brightest first; fewer only where fewer blocks glow
/// @throw Error(kUsage) if the count is below 1; Error(kInput) if a light would be brighter than
///        kMostLight of a colour of kMostLight
std::vector<Light> emissionLights(const Volume& volume, const Optics& optics, int count);

}  // namespace deltasplat
