// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "options/parse.h"

namespace deltasplat {

/// Frames that one command line may name.
inline constexpr std::size_t kMostFrames = 1'000'000;

/// Frame numbers, in the order in which they are named, each once: parts between commas, each a
/// number, `FIRST-LAST` (also downwards) or `FIRST-LASTxSTEP`; numbers may be negative.
Parser<std::vector<int>> frameList();

}  // namespace deltasplat
