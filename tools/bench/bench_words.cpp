// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/memory.h"
#include "base/text.h"
#include "text/axis_name.h"
#include "text/resolution_text.h"
#include "version.h"

namespace deltasplat {
namespace {

std::string counted(int count, const std::string& thing) {
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
    return fixedText(whole > 0 ? 100 * double(part) / double(whole) : 0, 2) + " %";
}

std::string by(int a, int b) {
    return std::to_string(a) + " x " + std::to_string(b);
}

}  // namespace

std::string millisecondsText(double seconds) {
    const double milliseconds = 1e3 * seconds;
    return fixedText(milliseconds, milliseconds < 1 ? 3 : 2);
}

std::string fixedText(double number, int digits) {
    if (!std::isfinite(number)) return "-";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, number);
    return text;
}

std::string groupedText(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (std::size_t left = text.size(); left > 3;) {
        left -= 3;
        text.insert(left, "\u202f");
    }
    return text;
}

std::string errorText(double error) {
    if (!std::isfinite(error)) return "none known";
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", error);
    return text;
}

std::string hardwareText(const Machine& machine) {
    std::string text =
        machine.cpu + ", " + counted(machine.logicalCores, "logical core") + ", " + machine.simd;
    if (machine.memoryBytes > 0)
        text += ", " + humanBytes(double(machine.memoryBytes)) + " of memory";
    return text;
}

std::string softwareText(const Machine& machine) {
    std::string text = "deltasplat " + programVersion();
    for (const auto& [library, version] : libraryVersions())
        text.append(", ").append(library).append(" ").append(version);
    return text + "; " + machine.compiler + "; " + machine.os;
}

std::string volumeText(const BenchRun& run) {
    const RenderStats& stats = run.stats;
    const std::string divided = stats.parts > 1 ? " divided into " + std::to_string(stats.parts)
                                : stats.joined > 1
                                    ? ", " + std::to_string(stats.joined) + " slices joined to one"
                                    : "";
    return by(run.dims.x, run.dims.y) + " x " + std::to_string(run.dims.z) + " voxels" + divided +
           ", " + percent(stats.visible, stats.voxels) + " visible, " +
           percent(stats.deltas, stats.voxels) + " deltas (comparability " +
           fixedText(run.comparability(), 4) + ")";
}

std::string pictureText(const BenchEntry& entry) {
    const BenchRun& run = entry.run;
    const RenderStats& stats = run.stats;
    return by(run.picture.size.x, run.picture.size.y) + " pixels, " + entry.mode + ", " +
           counted(run.threads, "thread") + "; " + counted(stats.slices, "slice") + " along " +
           axisName(stats.sliceAxis) + " in " + counted(stats.slabs, "slab") + ", " +
           sheetPixelsText(stats.resolution) + " a voxel, footprint " +
           by(stats.footprint, stats.footprint);
}

std::string identityText(const BenchRun& run) {
    const std::string compared = "all methods, " + counted(run.repeats + 1, "round") + " each";
    if (run.identical) return "the same, bit for bit: " + compared;
    return "DIFFERENT by up to " + errorText(run.maxDifference) + ": " + compared;
}

}  // namespace deltasplat
