// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_json.h"

#include "text/axis_name.h"
#include "text/json_text.h"
#include "text/resolution_text.h"
#include "version.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Timing& timing) {
    return {{"min", timing.min}, {"median", timing.median}};
}

Json toJson(const MethodRuns& method) {
    return {{"stamps", method.stamps},
            {"render", toJson(method.render)},
            {"splat", toJson(method.splat)},
            {"composite", toJson(method.composite)},
            {"warp", toJson(method.warp)},
            {"prepare", toJson(method.prepare)},
            {"nanoseconds_per_stamp", method.nanosecondsPerStamp()}};
}

// Infinity becomes null, as JSON has it.
Json toJson(const PictureDifference& difference) {
    return {{"color", difference.color}, {"alpha", difference.alpha}};
}

Json toJson(const ToleranceRuns& runs) {
    return {{"relative", runs.tolerance.relative},
            {"value", runs.tolerance.value},
            {"bound", toJson(runs.bound)},
            {"measured", toJson(runs.measured)},
            {"exact", {{"deltas", runs.exactDeltas}, {"stamps", runs.exactStamps}}}};
}

Json speedupJson(const BenchRun& run) {
    Json speedup;
    for (const Method faster : {Method::kDelta, Method::kAuto}) {
        for (const Method slower : {Method::kTraditional, Method::kSparse}) {
            speedup[methodName(slower) + "/" + methodName(faster)] = run.speedup(slower, faster);
        }
    }
    return speedup;
}

}  // namespace

Json machineJson(const Machine& machine) {
    Json versions;
    versions["deltasplat"] = programVersion();
    for (const auto& [library, version] : libraryVersions()) versions[library] = version;
    return {{"cpu", machine.cpu},   {"logical_cores", machine.logicalCores},
            {"simd", machine.simd}, {"memory_bytes", machine.memoryBytes},
            {"os", machine.os},     {"compiler", machine.compiler},
            {"versions", versions}};
}

Json runJson(const BenchEntry& entry) {
    const BenchRun& run = entry.run;
    const RenderStats& stats = run.stats;
    Json methods;
    for (const MethodRuns& method : run.methods)
        methods[methodName(method.method)] = toJson(method);
    Json json = {{"input", entry.input},
                 {"dims", {run.dims.x, run.dims.y, run.dims.z}},
                 {"mode", entry.mode},
                 {"size", {run.picture.size.x, run.picture.size.y}},
                 {"threads", run.threads},
                 {"repeats", run.repeats},
                 {"voxels", stats.voxels},
                 {"visible", stats.visible},
                 {"deltas", stats.deltas},
                 {"comparability", run.comparability()},
                 {"slices", stats.slices},
                 {"between", stats.between},
                 {"joined", stats.joined},
                 {"parts", stats.parts},
                 {"slabs", stats.slabs},
                 {"slice_axis", axisName(stats.sliceAxis)},
                 {"resolution", resolutionJson(stats.resolution)},
                 {"footprint", stats.footprint},
                 {"methods", methods},
                 {"prepare", toJson(run.prepare)},
                 {"speedup", speedupJson(run)},
                 {"identical", run.identical},
                 {"max_difference", run.maxDifference}};
    if (run.tolerance) json["tolerance"] = toJson(*run.tolerance);
    return json;
}

std::string jsonText(const BenchReport& report) {
    Json runs = Json::array();
    for (const BenchEntry& entry : report.entries) runs.push_back(runJson(entry));
    return dumpJson({{"machine", machineJson(report.machine)}, {"runs", runs}});
}

}  // namespace deltasplat
