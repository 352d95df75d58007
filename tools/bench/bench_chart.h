// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/bench_runs.h"

namespace deltasplat {

/// Returns an SVG element to stand in an HTML page: for each method one bar of the medians of
/// splat, composite and warp, and a thin one of prepare. Colours come from the page's style, by the
/// classes `splat`, `composite`, `warp`, `prepare`, `rule` and `quiet`.
std::string stageBars(const BenchRun& run);

}  // namespace deltasplat
