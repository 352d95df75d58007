// SPDX-License-Identifier: Apache-2.0
#include "render/render_stats.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "process/peak_bytes.h"
#include "text/axis_name.h"
#include "text/json_text.h"
#include "text/resolution_text.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

// What is not known is null.
nlohmann::ordered_json boundJson(double bound) {
    return std::isinf(bound) ? nlohmann::ordered_json() : nlohmann::ordered_json(bound);
}

std::string partsText(const RenderStats& stats) {
    if (stats.joined > 1) return "; " + std::to_string(stats.joined) + " slices joined to one";
    return stats.parts > 1 ? "; of voxels divided into " + std::to_string(stats.parts) : "";
}

std::string deepSummary(const DeepStats& deep) {
    if (deep.slicesPerSample == 0) return "";
    return countText(deep.samples, "sample") + ", at most " + std::to_string(deep.mostSamples) +
           " in a pixel\n";
}

std::string workSummary(const RenderStats& stats) {
    char text[256];
    const auto visible = (unsigned long long)stats.visible;
    const auto voxels = (unsigned long long)stats.voxels;
    if (stats.mode == Mode::kComposite) {
        std::snprintf(text, sizeof text,
                      "method %s: %llu stamps (%llu of %llu voxels visible, %llu deltas%s)\n",
                      methodName(stats.method).c_str(), (unsigned long long)stats.stamps, visible,
                      voxels, (unsigned long long)stats.deltas, partsText(stats).c_str());
    } else {
        std::snprintf(text, sizeof text, "mode %s: %llu of %llu voxels\n",
                      modeName(stats.mode).c_str(), visible, voxels);
    }
    return text;
}

}  // namespace

DeepStats deepStatsOf(const DeepImage& image, int slicesPerSample) {
    DeepStats stats{slicesPerSample, image.samples(), 0};
    for (const DeepRow& row : image.rows)
        for (std::size_t x = 0; x + 1 < row.begins.size(); ++x)
            stats.mostSamples = std::max(stats.mostSamples, row.begins[x + 1] - row.begins[x]);
    return stats;
}

std::string statsJson(const RenderResult& result, const Volume& volume, const RenderTimes& times,
                      const DeepStats& deep) {
    const RenderStats& stats = result.stats;
    const nlohmann::ordered_json seconds = {
        {"read", times.read},
        {"prepare", stats.prepareSeconds},
        {"splat", stats.splatSeconds},
        {"composite", stats.compositeSeconds},
        {"warp", stats.warpSeconds},
        {"write", times.write},
        {"render", stats.renderSeconds},
        {"total", times.total},
    };
    nlohmann::ordered_json json = {
        {"method", methodName(stats.method)},
        {"mode", modeName(stats.mode)},
        {"voxels", stats.voxels},
        {"visible", stats.visible},
        {"deltas", stats.deltas},
        {"stamps", stats.stamps},
        {"slices", stats.slices},
        {"between", stats.between},
        {"joined", stats.joined},
        {"parts", stats.parts},
        {"slabs", stats.slabs},
        {"slice_axis", axisName(stats.sliceAxis)},
        {"resolution", resolutionJson(stats.resolution)},
        {"footprint", stats.footprint},
        {"seconds", seconds},
        {"peak_bytes", peakBytes()},
        {"threads", threadCount()},
        {"simd", simdLevel()},
        {"tolerance", stats.tolerance.relative},
        {"tolerance_value", stats.tolerance.value},
        {"error_bound",
         {{"color", boundJson(stats.errorBoundColor)},
          {"alpha", boundJson(stats.errorBoundAlpha)}}},
    };
    if (deep.slicesPerSample > 0) {
        json["deep"] = {{"slices", deep.slicesPerSample},
                        {"samples", deep.samples},
                        {"most_samples", deep.mostSamples}};
    }
    json.update(placeJson(volume));
    // Not those of a front view, but the picture's own.
    json["target"] = vectorJson(result.camera.targetWorld);
    json["frame_width"] = result.camera.frameWidthWorld;
    json["camera"] = cameraJson(result.camera);
    return dumpJson(json);
}

std::string toleranceText(const Tolerance& tolerance) {
    if (tolerance.isExact()) return "0";
    std::string text;
    if (tolerance.relative > 0) text = numberText(tolerance.relative) + " of the colour";
    if (tolerance.value > 0)
        text += (text.empty() ? "" : " and ") + numberText(tolerance.value) + " data units";
    return text;
}

std::string codeErrorText(const CodeError& error) {
    if (error.absolute == 0) return "0";
    return numberText(error.absolute) + ", " + numberText(error.relative) + " of a value";
}

std::string errorBoundText(const RenderStats& stats) {
    if (std::isinf(stats.errorBoundColor)) return "unknown";
    // Three digits, rounded up.
    const auto text = [](double bound) {
        if (!(bound > 0)) return numberText(bound);
        const double last = std::pow(10, std::floor(std::log10(bound)) - 2);
        double rounded = std::ceil(bound / last);
        // What rounding of the quotient has taken away.
        if (rounded * last < bound) rounded += 1;
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, rounded * last,
                                       std::chars_format::general, 3);
        return std::string(digits, end.ptr);
    };
    return "color " + text(stats.errorBoundColor) + ", alpha " + text(stats.errorBoundAlpha);
}

std::string statsSummary(const RenderResult& result, const RenderTimes& times,
                         const DeepStats& deep) {
    const RenderStats& stats = result.stats;
    char text[512];
    char splats[128] = "";
    if (stats.mode == Mode::kComposite)
        std::snprintf(splats, sizeof splats, " in %d slabs, %s a voxel, footprint %dx%d",
                      stats.slabs, sheetPixelsText(stats.resolution).c_str(), stats.footprint,
                      stats.footprint);
    std::snprintf(text, sizeof text,
                  "%s%d slices along %s%s\n"
                  "seconds: read %.3f, prepare %.3f, render %.3f (splat %.3f, composite %.3f, "
                  "warp %.3f), write %.3f, total %.3f\n",
                  workSummary(stats).c_str(), stats.slices, axisName(stats.sliceAxis).c_str(),
                  splats, times.read, stats.prepareSeconds, stats.renderSeconds, stats.splatSeconds,
                  stats.compositeSeconds, stats.warpSeconds, times.write, times.total);
    char preview[64] = "";
    if (times.preview > 0)
        std::snprintf(preview, sizeof preview, "preview: %.3f seconds before\n", times.preview);
    return text + std::string(preview) + deepSummary(deep) +
           "camera: " + cameraOptionsText(result.camera) + "\n";
}

}  // namespace deltasplat
