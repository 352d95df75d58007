// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "bench/bench_report.h"
#include "bench/bench_words.h"
#include "render/render_stats.h"

namespace deltasplat {
namespace {

// One line of the table, as wide as its head.
std::string row(const std::string& method, const std::vector<std::string>& numbers) {
    char text[32];
    std::snprintf(text, sizeof text, "  %-11s", method.c_str());
    std::string line = text;
    const int widths[] = {12, 10, 10, 10, 10, 10, 10, 14, 9, 9};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::snprintf(text, sizeof text, " %*s", widths[i], numbers[i].c_str());
        line += text;
    }
    return line + "\n";
}

std::string methodRow(const BenchRun& run, const MethodRuns& method) {
    return row(methodName(method.method),
               {std::to_string(method.stamps), millisecondsText(method.prepare.median),
                millisecondsText(method.splat.median), millisecondsText(method.composite.median),
                millisecondsText(method.warp.median), millisecondsText(method.render.median),
                millisecondsText(method.render.min),
                fixedText(run.speedup(Method::kTraditional, method.method), 2),
                fixedText(run.speedup(Method::kSparse, method.method), 2),
                fixedText(method.nanosecondsPerStamp(), 2)});
}

std::string table(const BenchRun& run) {
    std::string text = row("method", {"stamps", "prepare", "splat", "composite", "warp", "render",
                                      "(least)", "traditional/it", "sparse/it", "ns/stamp"});
    for (const MethodRuns& method : run.methods) text += methodRow(run, method);
    return text;
}

std::string toleranceLines(const ToleranceRuns& runs, const BenchRun& run) {
    const auto line = [](const std::string& what, const PictureDifference& difference) {
        return "  " + what + " colour " + errorText(difference.color) + ", alpha " +
               errorText(difference.alpha) + "\n";
    };
    return "  tolerance " + toleranceText(runs.tolerance) + ": " +
           std::to_string(run.stats.deltas) + " deltas, exactly " +
           std::to_string(runs.exactDeltas) + "\n" + line("error bound:   ", runs.bound) +
           line("error measured:", runs.measured);
}

std::string plainText(const BenchEntry& entry) {
    const BenchRun& run = entry.run;
    std::string text = entry.input + "\n  " + volumeText(run) + "\n  " + pictureText(entry) +
                       "\n  milliseconds, medians of " + std::to_string(run.repeats) +
                       ", interleaved\n" + table(run) + "  pixels " + identityText(run) + "\n";
    if (run.tolerance) text += toleranceLines(*run.tolerance, run);
    return text;
}

}  // namespace

std::string plainText(const BenchReport& report) {
    std::string text = hardwareText(report.machine) + "\n" + softwareText(report.machine) + "\n";
    for (const BenchEntry& entry : report.entries) text += "\n" + plainText(entry);
    return text;
}

}  // namespace deltasplat
