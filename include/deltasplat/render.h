// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/render_options.h"

namespace deltasplat {

struct RenderResult {
    Image image;
    Camera camera;
    RenderStats stats;
};

/// Renders one picture. The same volume and options give the same pixels, bit for bit, for every
/// method, thread count and SIMD level. An empty volume gives a transparent picture.
///
/// Under kXray R = G = B = A = the line integral of the value in world units, under kMip, kMin and
/// kAverage R = G = B = the largest or smallest value, or the mean, and A = 1 where an active voxel
/// is met, and all 0 elsewhere: numbers, not light, that may be negative or larger than 1. Under
/// kDrr R = G = B = exp(-integral of mu), times the photons, and A = 1, also of an empty volume.
/// Inactive voxels count as 0, of kMip as the smallest value if that is negative, of kMin and
/// kAverage not at all, and let all x-rays through. Where the
/// code book is not exact and Volume::source is filled (ReadOptions::keepInexact), values are the
/// source's own.
/// @throw Error(kUsage) for options out of range; Error(kFailed) for a picture that does not fit
///        this machine's memory; whatever `listener.progress` throws
RenderResult render(const Volume& volume, const RenderOptions& options,
                    const Listener& listener = {});

/// Renders the picture that the program makes of a volume if nothing is asked for: from the front,
/// 512 pixels wide, by defaultOptics (optics/presets.h). A level set is then an opaque surface
/// only if it was read with ReadOptions::levelSetSurface; otherwise it is fog.
/// @throw as above
RenderResult render(const Volume& volume, const Listener& listener = {});

}  // namespace deltasplat
