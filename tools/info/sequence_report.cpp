// SPDX-License-Identifier: Apache-2.0
#include "info/sequence_report.h"

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <limits>

#include "base/text.h"
#include "options/parse.h"
#include "text/text_line.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A grid of all files.
struct CommonGrid {
    std::string name;
    std::size_t files = 0;   // that have it
    std::size_t filled = 0;  // in which any voxel of it is active
    std::size_t lastFile = 0, lastFilled = 0;
    double min = kInfinity;
    double max = -kInfinity;
    WorldBox box{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    std::uint64_t mostActive = 0;

    // @param number  of its file
    void add(const Volume& volume, std::size_t number) {
        if (files == 0 || lastFile != number) ++files;
        lastFile = number;
        if (volume.empty()) return;
        if (filled == 0 || lastFilled != number) ++filled;
        lastFilled = number;
        min = std::min(min, volume.valueMin());
        max = std::max(max, volume.valueMax());
        const WorldBox one = placeOf(volume).box;
        box = {glm::min(box.min, one.min), glm::max(box.max, one.max)};
        mostActive = std::max(mostActive, std::uint64_t(volume.activeCount()));
    }
};

// In the order in which they are first seen.
std::vector<CommonGrid> commonGrids(const std::vector<FileReport>& reports) {
    std::vector<CommonGrid> grids;
    for (std::size_t number = 0; number < reports.size(); ++number) {
        for (const GridReport& grid : reports[number].grids) {
            // A volume that has no name but its file's is the same in all of them.
            const std::string name = grid.volume.hasBackground() ? grid.volume.name() : "";
            auto found = std::find_if(grids.begin(), grids.end(),
                                      [&](const CommonGrid& one) { return one.name == name; });
            if (found == grids.end()) found = grids.insert(grids.end(), CommonGrid{name});
            found->add(grid.volume, number);
        }
    }
    return grids;
}

std::string placeText(const glm::dvec3& v) {
    return "(" + joinNumbers({v.x, v.y, v.z}, ", ") + ")";
}

}  // namespace

nlohmann::ordered_json sequenceJson(const std::vector<FileReport>& reports) {
    using Json = nlohmann::ordered_json;
    Json json = Json::array();
    for (const CommonGrid& grid : commonGrids(reports)) {
        const bool isEmpty = grid.filled == 0;
        const Json box{vectorJson(grid.box.min), vectorJson(grid.box.max)};
        json.push_back({{"name", grid.name.empty() ? Json() : Json(grid.name)},
                        {"files", grid.files},
                        {"filled", grid.filled},
                        {"range", isEmpty ? Json() : Json{grid.min, grid.max}},
                        {"world_box", isEmpty ? Json() : box},
                        {"most_active", grid.mostActive}});
    }
    return json;
}

std::string sequenceText(const std::vector<FileReport>& reports, std::size_t asked) {
    const std::string count = std::to_string(reports.size());
    std::string text =
        (reports.size() == asked ? "All " + count : count + " of " + std::to_string(asked)) +
        " frames\n";
    for (const CommonGrid& grid : commonGrids(reports)) {
        if (!grid.name.empty()) text += textLine("grid", grid.name);
        text += textLine("frames", std::to_string(grid.files) + ", with active voxels in " +
                                       std::to_string(grid.filled));
        if (grid.filled == 0) continue;
        text += textLine("range", numberText(grid.min) + " to " + numberText(grid.max));
        text += textLine("world box", placeText(grid.box.min) + " to " + placeText(grid.box.max));
        text += textLine("active", "up to " + std::to_string(grid.mostActive));
    }
    return text;
}

}  // namespace deltasplat
