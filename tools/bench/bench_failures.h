// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/bench_report.h"
#include "deltasplat/error.h"

namespace deltasplat {

/// Adds a failure for an entry whose pixels differ: all methods promise the same ones.
void addDifference(const BenchEntry& entry, std::vector<Error>& failures);

/// Shows all failures but the last one, which ends the program and is shown as every error is.
/// Returns if there are none.
/// @throw Error  the last failure
void throwFailures(const std::vector<Error>& failures);

}  // namespace deltasplat
