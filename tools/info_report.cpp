// SPDX-License-Identifier: Apache-2.0
#include "info_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "json_text.h"
#include "number_text.h"
#include "parse.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAxisNames[] = {"x", "y", "z"};

template <class Vector>
Json toJson(const Vector& v) {
    return Json::array({v.x, v.y, v.z});
}

template <class Vector>
std::string toText(const Vector& v, const std::string& separator) {
    return joinNumbers({double(v.x), double(v.y), double(v.z)}, separator);
}

Json toJson(const GridReport& report) {
    const Volume& volume = report.volume;
    Json axes;
    for (int axis = 0; axis < 3; ++axis) {
        axes[kAxisNames[axis]] = {{"visible", report.counts[axis].visible},
                                  {"deltas", report.counts[axis].deltas},
                                  {"comparability", comparability(report, axis)}};
    }
    return {{"name", volume.name},
            {"type", volume.type},
            {"class", volume.gridClass},
            {"dims", toJson(volume.box.dims())},
            {"bbox", {toJson(volume.box.min), toJson(volume.box.max)}},
            {"voxel_size", toJson(volume.voxelSize())},
            {"active", volume.activeCount},
            {"range", {volume.valueMin, volume.valueMax}},
            {"background", volume.background},
            {"code_book", volume.codeBook.name()},
            {"axes", axes}};
}

std::string line(const std::string& label, const std::string& value) {
    return "  " + label + std::string(label.size() < 14 ? 14 - label.size() : 1, ' ') + value +
           "\n";
}

std::string percent(double part, double whole) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f %%", whole > 0 ? 100 * part / whole : 0.0);
    return text;
}

std::string axisText(const GridReport& report, int axis) {
    const SliceCounts& counts = report.counts[axis];
    char text[32];
    std::snprintf(text, sizeof text, "%.4f", comparability(report, axis));
    return "comparability " + std::string(text) + ", " + std::to_string(counts.deltas) +
           " deltas (" + percent(double(counts.deltas), double(report.volume.box.voxels())) + ")";
}

std::string plainText(const GridReport& report) {
    const Volume& v = report.volume;
    std::string text = line("grid", v.name) + line("type", v.type) + line("class", v.gridClass);
    text += line("dims", toText(v.box.dims(), " x "));
    text += line("box", v.empty() ? "empty"
                                  : "(" + toText(v.box.min, ", ") + ") to (" +
                                        toText(v.box.max, ", ") + ")");
    text += line("voxel size", toText(v.voxelSize(), " x "));
    text += line("active", std::to_string(v.activeCount) + " (" +
                               percent(double(v.activeCount), double(v.box.voxels())) + ")");
    text += line("range",
                 v.empty() ? "none" : numberText(v.valueMin) + " to " + numberText(v.valueMax));
    text += line("background", numberText(v.background)) + line("code book", v.codeBook.name());
    for (int axis = 0; axis < 3; ++axis)
        text += line(std::string("along ") + kAxisNames[axis], axisText(report, axis));
    return text;
}

}  // namespace

double comparability(const GridReport& report, int axis) {
    const double voxels = double(report.volume.box.voxels());
    return voxels > 0 ? 1 - double(report.counts[axis].deltas) / voxels : 1;
}

std::string jsonText(const std::vector<FileReport>& reports) {
    Json files = Json::array();
    for (const FileReport& report : reports) {
        Json grids = Json::array();
        for (const GridReport& grid : report.grids) grids.push_back(toJson(grid));
        files.push_back({{"file", report.file}, {"grids", grids}});
    }
    return dumpJson({{"files", files}});
}

std::string plainText(const std::vector<FileReport>& reports) {
    std::string text;
    for (const FileReport& report : reports) {
        text += (text.empty() ? "" : "\n") + report.file + "\n";
        for (std::size_t i = 0; i < report.grids.size(); ++i)
            text += (i > 0 ? "\n" : "") + plainText(report.grids[i]);
        for (const std::string& grid : report.others) text += line("not read", grid);
    }
    return text;
}

}  // namespace deltasplat
