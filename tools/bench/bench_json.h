// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/bench_report.h"

namespace deltasplat {

/// Returns the object `machine` of `bench --json`.
nlohmann::ordered_json machineJson(const Machine& machine);

/// Returns one of the objects in `runs` of `bench --json`.
nlohmann::ordered_json runJson(const BenchEntry& entry);

}  // namespace deltasplat
