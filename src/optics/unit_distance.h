// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "view/affine.h"

namespace deltasplat {

/// Returns the world length over which opacities hold.
inline double unitDistanceOf(const Volume& volume, const Optics& optics) {
    return optics.unitDistance.value_or(smallestSize(volume));
}

}  // namespace deltasplat
