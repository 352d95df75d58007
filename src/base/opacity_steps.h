// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace deltasplat {

/// Opacities become those of so many steps: a becomes 1 - (1 - a)^steps, right to 2e-6 of itself
/// and the same bits at every SIMD level.
/// @param steps  [count], and kStepsSpare more
void repeatOpacity(float* opacities, const float* steps, std::size_t count);

/// Vectors of steps may be read so far over the end.
inline constexpr std::size_t kStepsSpare = 16;

}  // namespace deltasplat
