// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec4.hpp>
#include <optional>
#include <string>

#include "bench/bench_runs.h"

namespace deltasplat {

/// What pictures on the page stand on, scene-linear; empty: nothing but the page's dark.
using Background = std::optional<glm::vec4>;

/// Returns a rendered picture over the background, over the page's dark, as a `data:` URI.
/// @throw Error(kOutput) if it cannot be encoded
std::string shownPicture(Image picture, const Background& background);

/// Returns what the page says about a tolerance: the exact picture, the one under tolerance and
/// where they differ, the proved bound beside what was measured.
/// @throw Error(kOutput) if the pictures cannot be encoded
std::string toleranceHtml(const BenchRun& run, const ToleranceRuns& runs,
                          const Background& background);

}  // namespace deltasplat
