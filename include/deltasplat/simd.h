// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace deltasplat {

/// Returns the names of the SIMD levels this machine can run, best first, for example
/// `{"AVX3_DL", "AVX3", "AVX2", "SSE4", "SSE2"}`.
std::vector<std::string> simdLevels();

/// Returns the name of the level in use.
std::string simdLevel();

/// Makes every kernel run at the level `name` (any case), or at the best one for "auto"; pixels
/// stay the same. For tests and measurements. Not thread-safe: call it before rendering.
/// @throw Error(kUsage) if the machine does not have that level
void setSimdLevel(const std::string& name);

}  // namespace deltasplat
