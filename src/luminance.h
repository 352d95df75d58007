// SPDX-License-Identifier: Apache-2.0
// Based on: ITU-R BT.709-6, 2015, item 3.2.
#pragma once

#include <glm/vec3.hpp>

namespace deltasplat {

/// Shares of red, green and blue in how bright linear light is; they add up to 1, so a grey keeps
/// its value.
inline constexpr glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722);

}  // namespace deltasplat
