// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "composite/slab_renderer.h"
#include "deltasplat/image/pixel_box.h"
#include "picture/plane_view.h"

namespace deltasplat {

/// Some of a picture's pixels, and what of the slabs shows in them, from the front on.
struct PlanePart {
    PixelBox pixels;
    std::vector<SeenSlab> slabs;
    PlaneBox whole;  ///< what all slabs reach of the plane, of which there is a part; else empty
};

/// Cuts a picture into parts where most of its base plane would be empty, or out of the picture:
/// base plane and sheets of a part have what voxels reach of it alone, so that a picture costs by
/// the voxels that it shows, not by the box that they lie in. Bits are those of the whole.
/// @param pixels  of the picture, that are wanted
/// @return what shows anything; a single part, of all slabs as they are, where the plane is not
///         that large or full enough
std::vector<PlanePart> planeParts(const SlabInput& input, const PlaneView& plane,
                                  const PixelBox& pixels);

/// Calls `show` for each part with where it is written; what no part shows is clear.
/// @param all         what is wanted of the picture
/// @param writesAll   whether who shows writes all pixels of a part; else some, into those that
///                    there are
void showParts(std::vector<PlanePart>& parts, const PicturePart& all, bool writesAll,
               const std::function<void(PlanePart& part, const PicturePart& to)>& show);

}  // namespace deltasplat
