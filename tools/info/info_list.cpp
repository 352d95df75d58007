// SPDX-License-Identifier: Apache-2.0
#include "info/info_list.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "options/parse.h"
#include "options/volume_choices.h"
#include "text/json_text.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::array<std::string, 4>;

// One long name does not make every line as long.
constexpr std::size_t kWidest = 48;

std::string indexText(const glm::ivec3& index) {
    return "(" + joinNumbers({double(index.x), double(index.y), double(index.z)}, ", ") + ")";
}

std::string boxText(const VolumeEntry& volume) {
    if (!volume.box) return "-";
    if (volume.box->empty()) return "empty";
    return indexText(volume.box->min) + " to " + indexText(volume.box->max);
}

std::string remarks(const VolumeEntry& volume) {
    std::string text = volume.series ? "  series " + seriesText(volume) : "";
    if (!volume.scalar)
        return text + "  not read" + (volume.obstacle.empty() ? "" : ": " + volume.obstacle);
    if (volume.delta) text += "  delta grid";
    if (volume.volumes > 1) text += "  " + std::to_string(volume.volumes) + " volumes";
    return text + (volume.preferred ? "  default" : "");
}

Row rowOf(const VolumeEntry& volume) {
    return {volume.name.empty() ? "\"\"" : volume.name, volume.type,
            volume.gridClass.empty() ? "-" : volume.gridClass, boxText(volume)};
}

std::string tableText(const std::vector<VolumeEntry>& volumes) {
    std::array<std::size_t, 4> widths{};
    for (const VolumeEntry& volume : volumes) {
        const Row row = rowOf(volume);
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], std::min(row[i].size(), kWidest));
    }
    std::string text;
    for (const VolumeEntry& volume : volumes) {
        const Row row = rowOf(volume);
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line +=
                "  " + row[i] + std::string(widths[i] - std::min(widths[i], row[i].size()), ' ');
        line += remarks(volume);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

Json boxJson(const VolumeEntry& volume) {
    if (!volume.box || volume.box->empty()) return Json();
    const glm::ivec3 &min = volume.box->min, &max = volume.box->max;
    return {{min.x, min.y, min.z}, {max.x, max.y, max.z}};
}

}  // namespace

std::string plainText(const std::vector<FileListing>& files) {
    std::string text;
    for (const FileListing& file : files) text += file.file + "\n" + tableText(file.volumes);
    return text;
}

std::string jsonText(const std::vector<FileListing>& files) {
    Json list = Json::array();
    for (const FileListing& file : files) {
        Json grids = Json::array();
        for (const VolumeEntry& volume : file.volumes) {
            grids.push_back({{"name", volume.name},
                             {"type", volume.type},
                             {"class", volume.gridClass.empty() ? Json() : Json(volume.gridClass)},
                             {"bbox", boxJson(volume)},
                             {"series", volume.series ? Json(*volume.series) : Json()},
                             {"description", volume.description},
                             {"volumes", volume.volumes},
                             {"scalar", volume.scalar},
                             {"delta", volume.delta},
                             {"default", volume.preferred}});
        }
        list.push_back({{"file", file.file}, {"grids", grids}});
    }
    return dumpJson({{"files", list}});
}

}  // namespace deltasplat
