// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/grid_metadata.h"

#include <openvdb/Grid.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "files/file_name.h"
#include "formats/delta/delta_format.h"
#include "formats/input_files.h"
#include "formats/vdb/vdb_file.h"

namespace deltasplat {

namespace {

// Replaces control characters by blanks, so that the text stays on one line.
std::string inLine(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    }
    return text;
}

// Takes the next word of a line, and the blank after it.
std::string takeWord(std::string& line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string word = line.substr(0, end);
    line.erase(0, std::min(end + 1, line.size()));
    return word;
}

template <typename T>
bool read(const std::string& word, T& number) {
    const char* const end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, number);
    return result.ec == std::errc{} && result.ptr == end;
}

std::optional<LabelEntry> labelOf(std::string line) {
    LabelEntry label;
    if (!read(takeWord(line), label.value)) return {};
    std::string word = takeWord(line);
    if (word != "-") {
        glm::dvec3 rgb(0);
        for (int channel = 0; channel < 3; ++channel) {
            if (channel > 0) word = takeWord(line);
            if (!read(word, rgb[channel]) || !(rgb[channel] >= 0 && rgb[channel] <= 1)) return {};
        }
        label.rgb = rgb;
    }
    label.name = line;
    return label;
}

}  // namespace

std::string labelText(const LabelList& labels) {
    std::string text;
    for (const LabelEntry& label : labels.entries) {
        text += std::to_string(label.value) + " ";
        text += label.rgb ? numberText(label.rgb->r) + " " + numberText(label.rgb->g) + " " +
                                numberText(label.rgb->b)
                          : "-";
        text += " " + inLine(label.name) + "\n";
    }
    return text;
}

std::shared_ptr<const LabelList> labelsIn(const VdbMetadata& metadata) {
    const auto text = metadata.get<std::string>(kLabelsKey);
    return text ? labelsOfText(*text) : nullptr;
}

std::shared_ptr<const LabelList> labelsOfText(const std::string& text) {
    auto labels = std::make_shared<LabelList>();
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (std::optional<LabelEntry> label = labelOf(line))
            labels->entries.push_back(std::move(*label));
    }
    return labels;
}

std::string gridClassOf(const VdbMetadata& metadata) {
    constexpr const char* kSpaces = " \t\n\v\f\r";
    const std::string stored = metadata.text(openvdb::GridBase::META_GRID_CLASS);
    const std::size_t begin = stored.find_first_not_of(kSpaces);
    if (begin == std::string::npos) return kUnknownClass;
    const std::string name =
        lowerCase(stored.substr(begin, stored.find_last_not_of(kSpaces) + 1 - begin));
    const bool isKnown = name == kLevelSetClass || name == kFogClass || name == kStaggeredClass;
    return isKnown ? name : kUnknownClass;
}

namespace {

// Names in caches of smoke and fire simulations (Mantaflow, Houdini).
constexpr std::array<std::string_view, 8> kHelpers{
    "flags", "shadow", "pressure", "obstacle", "obstacles", "collision", "divergence", "mask"};
constexpr std::array<std::string_view, 2> kHelperBegins{"phi", "fractions"};
// The surface of a liquid, which its simulation keeps for its own sake. Other names with this
// beginning belong to obstacles and inflows.
constexpr std::string_view kSurface = "phi";
constexpr std::array<std::string_view, 4> kHelperEnds{"_noise", "_inflow", "_in", "_old"};

enum Rank { kNone, kHelper, kHelperFog, kSurfaceOfLiquid, kOther, kFog };

Rank rankOf(const VdbFile& file, const VdbGrid& grid, VdbBytes& bytes) {
    if (grid.vector) return kNone;
    const std::string gridClass = gridClassOf(file.summary(grid, bytes).metadata);
    // A grid of unknown type counts only if its class says that it holds numbers.
    if (!grid.numeric && gridClass != kFogClass && gridClass != kLevelSetClass) return kNone;
    const bool fog = gridClass == kFogClass;
    const std::string name = grid.plainName();
    if (lowerCase(name) == kSurface) return kSurfaceOfLiquid;
    if (isHelperName(name)) return fog ? kHelperFog : kHelper;
    return fog ? kFog : kOther;
}

const VdbGrid* densityOf(const VdbFile& file) {
    const VdbGrid* found = nullptr;
    for (const VdbGrid& grid : file.grids()) {
        if (grid.plainName() != "density") continue;
        if (grid.numeric) return &grid;
        if (!found) found = &grid;
    }
    return found;
}

}  // namespace

bool isHelperName(const std::string& gridName) {
    const std::string name = lowerCase(gridName);
    return std::any_of(kHelpers.begin(), kHelpers.end(), [&](auto word) { return name == word; }) ||
           std::any_of(kHelperBegins.begin(), kHelperBegins.end(),
                       [&](auto word) { return name.starts_with(word); }) ||
           std::any_of(kHelperEnds.begin(), kHelperEnds.end(),
                       [&](auto word) { return name.ends_with(word); });
}

const VdbGrid* defaultGrid(const VdbFile& file) {
    if (const VdbGrid* const density = densityOf(file)) return density;
    const VdbGrid* best = nullptr;
    Rank bestRank = kNone;
    VdbBytes bytes = file.bytes();
    for (const VdbGrid& grid : file.grids()) {
        const Rank rank = rankOf(file, grid, bytes);
        if (rank <= bestRank) continue;
        best = &grid;
        bestRank = rank;
        if (rank == kFog) break;
    }
    return best;
}

const VdbGrid* toldDefaultGrid(const VdbFile& file) {
    try {
        return defaultGrid(file);
    } catch (const Error&) {
        return nullptr;
    }
}

namespace {

// Names in caches of Houdini, Mantaflow, EmberGen and others; those that best show flames first.
constexpr std::array<std::string_view, 6> kFires{"flame", "flames", "fire",
                                                 "burn",  "heat",   "temperature"};
constexpr std::array<std::string_view, 4> kColors{"cd", "color", "colour", "albedo"};

}  // namespace

bool isColorType(const std::string& type) {
    return type == "vec3s" || type == "vec3d";
}

MediumGrids mediumGrids(const std::vector<VolumeEntry>& entries) {
    const auto firstOf = [&](const auto& names, const auto& suits) -> std::string {
        for (const std::string_view name : names) {
            for (const VolumeEntry& entry : entries)
                if (suits(entry) && lowerCase(entry.name) == name) return entry.name;
        }
        return "";
    };
    MediumGrids grids;
    // An unreadable grid is still the one that is meant: reading it says why.
    grids.emission = firstOf(
        kFires, [](const VolumeEntry& entry) { return entry.scalar || !entry.obstacle.empty(); });
    grids.color =
        firstOf(kColors, [](const VolumeEntry& entry) { return isColorType(entry.type); });
    grids.otherEmission = firstOf(kFires, [&](const VolumeEntry& entry) {
        const bool isEmpty = entry.box && entry.box->empty();
        return entry.scalar && !isEmpty && entry.name != grids.emission;
    });
    return grids;
}

GridList listGrids(const std::filesystem::path& file) {
    requireRegularFile(file);
    if (inputsAreConfined()) requireConfined(file);
    GridList list;
    const VdbFile vdb(file);
    const VdbGrid* const preferred = toldDefaultGrid(vdb);
    if (preferred && preferred->isScalar()) list.preferred = preferred->name;
    for (const VdbGrid& grid : vdb.grids()) {
        if (grid.isScalar()) {
            list.scalar.push_back(grid.name);
        } else {
            list.others.push_back(grid.describe());
        }
        const bool mayBeDelta = grid.type == "int32" || grid.type == "int64";
        if (mayBeDelta && isDeltaGrid(grid.type, vdb.metadata(grid))) {
            list.deltas.push_back(grid.name);
        } else {
            list.ordinary.push_back(grid.describe());
        }
    }
    return list;
}

}  // namespace deltasplat
