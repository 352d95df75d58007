// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "deltasplat/image/deep_image.h"

namespace deltasplat {

/// Adds the samples of a pixel to others as they are stored: with NaN as 0, the rest clamped to
/// finite numbers, and without those that are nothing then. Halves are rounded so that samples over
/// each other stay the pixel: each makes up for what was rounded before it. What is not 1 is no 1
/// where anything lies behind.
/// @param samples  from the front to the back
/// @param asFloat  colour and alpha as floats instead of halves
void addStored(std::span<const DeepSample> samples, bool asFloat, std::vector<DeepSample>& stored);

}  // namespace deltasplat
