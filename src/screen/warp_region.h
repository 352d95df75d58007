// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/view/camera.h"
#include "screen/warp.h"
#include "view/base_plane.h"

namespace deltasplat {

/// Resamples the base plane of a region of a picture that is seen from an eye: writes those pixels
/// whose lines of sight belong to its slice axis, with a filter that is widened where the picture
/// is coarser than the plane. Deterministic; multi-threaded.
/// @param raster  pixels of the plane
/// @param view    of the volume's own voxels
/// @param thin    of what they are divided into, which the plane is of
/// @return the most by which it can enlarge a difference of rasters
double warpRegion(const Raster& raster, const Camera& camera, const Factorization& view,
                  const Factorization& thin, const BasePlane& plane, WarpFilter filter,
                  const PicturePart& part);

/// Returns the pixels of the plane that some of the picture's read, and a few around them.
PlaneBox readByRegion(const Camera& camera, const Factorization& view, const Factorization& thin,
                      const BasePlane& plane, const PixelBox& pixels);

}  // namespace deltasplat
