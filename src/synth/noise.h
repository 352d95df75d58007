// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "synth/volumes.h"

namespace deltasplat {

/// Adds normally distributed noise to a volume, and clamps to 0..1.
/// @param noise  standard deviation; 0 changes nothing
ValueAt withNoise(ValueAt valueAt, std::uint64_t seed, double noise);

}  // namespace deltasplat
