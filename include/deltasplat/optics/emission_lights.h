// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/shading.h"

namespace deltasplat {

/// Turns the glowing parts of a medium into point lights, so that fire lights the fog around it
/// (Scattering): each group of glowing blocks of 8x8x8 voxels close together becomes one light. It
/// sends out all the light of its group, from the group's mean place. Its radius is that of an
/// evenly glowing ball, as widely spread as the group, that lights its middle equally. Nothing is
/// subtracted for what dims the fire on the way. Deterministic, whatever the number of threads.
/// @param volume  gives the voxels at which parts are read and the unit distance; may be empty
/// @param optics  with the parts; absorbing parts do not shine
/// @param count   of lights, >= 1
/// @return at most `count` lights, brightest first; fewer only where fewer blocks glow
/// @throw Error(kUsage) if the count is below 1; Error(kInput) for a light of colour kMostLight
///        brighter than kMostLight
std::vector<Light> emissionLights(const Volume& volume, const Optics& optics, int count);

}  // namespace deltasplat
