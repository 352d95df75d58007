// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/bench_page_parts.h"
#include "bench/bench_runs.h"
#include "bench/machine.h"

namespace deltasplat {

/// One volume of a report.
struct BenchEntry {
    std::string input;  ///< as given
    std::string mode;   ///< what the picture shows: "composite"
    BenchRun run;
};

/// All that `bench` has to say.
struct BenchReport {
    Machine machine;
    std::string commandLine;
    std::vector<BenchEntry> entries;
};

/// Returns one JSON object with a line end; times in seconds, what is not known as null.
std::string jsonText(const BenchReport& report);

/// Returns the machine, and for each volume a table of the four methods; times in milliseconds.
std::string plainText(const BenchReport& report);

/// Returns a whole HTML page that needs nothing but itself: pictures, bars, tables.
/// @param background  what the pictures stand on; empty: the page's dark
/// @throw Error(kOutput) if the pictures cannot be encoded
std::string pageText(const BenchReport& report, const Background& background);

}  // namespace deltasplat
