// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_failures.h"

#include "base/text.h"
#include "listener.h"

namespace deltasplat {

void addDifference(const BenchEntry& entry, std::vector<Error>& failures) {
    if (entry.run.identical) return;
    failures.emplace_back(ErrorCode::kFailed,
                          gotExpected(entry.input,
                                      "pixels that differ by up to " +
                                          numberText(entry.run.maxDifference) + " between methods",
                                      "the same bits from all methods in all rounds"));
}

void throwFailures(const std::vector<Error>& failures) {
    if (failures.empty()) return;
    for (std::size_t i = 0; i + 1 < failures.size(); ++i) showError(failures[i].what());
    throw failures.back();
}

}  // namespace deltasplat
