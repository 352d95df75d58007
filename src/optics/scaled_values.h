// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "optics/voxel_painter.h"

namespace deltasplat {

/// Returns a volume's values as gradients are taken of them: how far they are from one of them, in
/// units of the change that is half noise, half surface.
/// @param noise  that change; empty: gradientNoise
GradientScale scaledValues(const Volume& volume, double zero,
                           const std::optional<double>& noise = std::nullopt);

/// Returns a hundredth of where most values lie (bulkRange), or of where all do.
double gradientNoise(const Volume& volume);

}  // namespace deltasplat
