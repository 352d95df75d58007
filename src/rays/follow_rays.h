// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/progress.h"
#include "rays/ray_band.h"

namespace deltasplat {

/// Follows all lines of sight through the base plane's pixels, on all threads. Deterministic: what
/// a pixel gets depends on the volume and the view alone.
/// @return sums of values, or their largest, -infinity where no active voxel is met; places where
///         they are asked for
/// @throw Error(kFailed) if it does not fit into memory; whatever `listener.progress` throws
RayPlanes followRays(const RayInput& input, const Listener& listener);

}  // namespace deltasplat
