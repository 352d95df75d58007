// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns a volume's values as gradients are taken of them: how far they are from one of them, in
/// units of the change that is half noise, half surface. That is a hundredth of the way between
/// where most values lie (bulkRange); whatever is beyond them does not count.
GradientScale scaledValues(const Volume& volume, double zero);

}  // namespace deltasplat
