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
/// kXray gives R = G = B = A = the line integral of the value in world units. kMip, kMin and
/// kAverage give R = G = B = the largest value, the smallest or the mean, and A = 1 where an active
/// voxel is met; all four are 0 elsewhere. These are numbers, not light, and may be negative or
/// larger than 1. kDrr gives R = G = B = exp(-integral of mu), times the photons, and A = 1, also
/// for an empty volume. Inactive voxels let all x-rays through in kDrr, do not count in kMin and
/// kAverage, and are 0 otherwise, in kMip the smallest value if negative. With an inexact code
/// book, values are the source's own if Volume::source is filled (ReadOptions::keepInexact).
/// @throw Error(kUsage) for options out of range; Error(kFailed) for a picture that does not fit
///        this machine's memory; whatever `listener.progress` throws
RenderResult render(const Volume& volume, const RenderOptions& options,
                    const Listener& listener = {});

/// Renders a volume as the program does by default: from the front, 512 pixels wide, by
/// defaultOptics (optics/presets.h). A level set is an opaque surface only if it was read with
/// ReadOptions::levelSetSurface; otherwise it is fog.
/// @throw as above
RenderResult render(const Volume& volume, const Listener& listener = {});

}  // namespace deltasplat
