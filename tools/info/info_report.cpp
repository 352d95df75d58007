// SPDX-License-Identifier: Apache-2.0
#include "info/info_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "deltasplat/ingest/label_list.h"
#include "deltasplat/ingest/value_statistics.h"
#include "info/sequence_report.h"
#include "text/json_text.h"
#include "volume/code_math.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAxisNames[] = {"x", "y", "z"};
constexpr int kBins = 64;

template <class Vector>
Json toJson(const Vector& v) {
    return Json::array({v.x, v.y, v.z});
}

Json histogramJson(const Volume& volume) {
    const ValueHistogram histogram = histogramOfValues(volume, kBins);
    return {{"low", histogram.low}, {"high", histogram.high}, {"counts", histogram.counts}};
}

Json labelsJson(const Volume& volume) {
    if (!volume.labels()) return {};
    Json labels = Json::array();
    for (const LabelEntry& label : volume.labels()->entries) {
        const glm::dvec3 rgb = label.rgb.value_or(glm::dvec3(0));
        labels.push_back({{"value", label.value},
                          {"name", label.name},
                          {"color", label.rgb ? Json{rgb.r, rgb.g, rgb.b} : Json()}});
    }
    return labels;
}

Json percentilesJson(const Volume& volume) {
    Json percentiles;
    for (const int percent : {1, 50, 99}) {
        percentiles[std::to_string(percent)] = percentileValue(volume, percent);
    }
    return percentiles;
}

Json toJson(const StampCounts& stamps) {
    return {{"traditional", stamps.traditional},
            {"sparse", stamps.sparse},
            {"delta", stamps.delta},
            {"auto", stamps.automatic}};
}

Json toJson(const DeltaOrigin& origin) {
    return {{"slice_axis", kAxisNames[origin.sliceAxis]},
            {"key_interval", origin.keyInterval},
            {"deltas", origin.deltas},
            {"code_book", origin.codeBook},
            {"tolerance", origin.tolerance},
            {"tolerance_value", origin.toleranceValue},
            {"max_error", origin.maxError}};
}

// How many active voxels have the guessed value; of a background nobody counts them.
Json guessedVoxels(const GridReport& report) {
    if (report.volume.hasBackground() || !report.backgroundGuess) return {};
    return report.volume.mostFrequent()->count;
}

Json toJson(const GridReport& report, const Json& transferFunction) {
    const Volume& volume = report.volume;
    Json axes;
    Json stamps;
    for (int axis = 0; axis < 3; ++axis) {
        axes[kAxisNames[axis]] = {{"visible", report.counts[axis].visible},
                                  {"deltas", report.counts[axis].deltas},
                                  {"comparability", comparability(report, axis)}};
        stamps[kAxisNames[axis]] = toJson(report.stamps[axis]);
    }
    return {
        {"name", volume.name()},
        {"type", volume.type()},
        {"class", volume.gridClass()},
        {"series", report.entry.series ? Json(*report.entry.series) : Json()},
        {"description", report.entry.description},
        {"volume", report.volumeIndex},
        {"volumes", report.entry.volumes},
        {"dims", toJson(volume.box().dims())},
        {"bbox", {toJson(volume.box().min), toJson(volume.box().max)}},
        {"voxel_size", toJson(volume.voxelSize())},
        {"active", volume.activeCount()},
        {"range", {volume.valueMin(), volume.valueMax()}},
        {"background", volume.background()},
        {"background_guess", report.backgroundGuess ? Json(*report.backgroundGuess) : Json()},
        {"background_voxels", guessedVoxels(report)},
        {"labels", labelsJson(volume)},
        {"percentiles", percentilesJson(volume)},
        {"histogram", histogramJson(volume)},
        {"code_book", volume.codeBook().name()},
        {"code_error",
         {{"absolute", volume.codeError().absolute}, {"relative", volume.codeError().relative}}},
        {"delta", volume.origin() ? toJson(*volume.origin()) : Json()},
        {"axes", axes},
        {"transfer_function", transferFunction},
        {"stamps", stamps}};
}

}  // namespace

double comparability(const GridReport& report, int axis) {
    const double voxels = double(voxelsOf(report.volume.box()));
    return voxels > 0 ? 1 - double(report.counts[axis].deltas) / voxels : 1;
}

std::string jsonText(const std::vector<FileReport>& reports, const std::string& transferFunction,
                     bool isSequence) {
    const Json usedFunction = transferFunction.empty() ? Json() : Json(transferFunction);
    Json files = Json::array();
    for (const FileReport& report : reports) {
        Json grids = Json::array();
        for (const GridReport& grid : report.grids) {
            grids.push_back(toJson(grid, usedFunction));
            grids.back().update(placeJson(grid.volume));
        }
        const auto nameOf = [](const std::string& name) {
            return name.empty() ? Json() : Json(name);
        };
        files.push_back({{"file", report.file},
                         {"emission_grid", nameOf(report.medium.emission)},
                         {"color_grid", nameOf(report.medium.color)},
                         {"grids", grids}});
    }
    Json json{{"files", files}};
    if (isSequence) json["sequence"] = sequenceJson(reports);
    return dumpJson(json);
}

}  // namespace deltasplat
