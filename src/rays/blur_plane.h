// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/splat/footprint.h"
#include "rays/ray_plane.h"

namespace deltasplat {

/// Stamps the footprint once for each pixel of a plane, scaled by its value, on all threads: what
/// splatting every voxel would have given, for splatting is linear. Weights are real numbers that
/// add up to 1. Sheet pixels are voxels.
/// @param plane  with a border of zeros that is wider than the footprint reaches
/// @param scale  what every value is multiplied with
RayPlane blurPlane(const RayPlane& plane, const Footprint& footprint, float scale);

}  // namespace deltasplat
