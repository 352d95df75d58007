// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// Returns the largest share of light that anything can take away on the way through the shortest
/// side of a voxel, 0..1, by the transfer function alone: whatever values the volume has, and
/// whichever side it is seen from.
/// @throw as classify
double largestAlpha(const Volume& volume, const Optics& optics);

}  // namespace deltasplat
