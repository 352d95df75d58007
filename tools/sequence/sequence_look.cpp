// SPDX-License-Identifier: Apache-2.0
#include "sequence/sequence_look.h"
#include "volume/placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "deltasplat/error.h"
#include "files/checked_json.h"
#include "formats/vdb/grid_metadata.h"
#include "volume/code_tree.h"

namespace deltasplat {
namespace {

// Box corners that are whole voxels but for rounding are those.
constexpr double kRounding = 1e-6;
constexpr std::size_t kEmptyOrder = std::size_t{1} << 40;

double bytesOf(const Volume& volume) {
    return volume.codes() ? double(volume.codes()->memoryBytes()) : 0;
}

// The smallest box of voxels that holds a box of the world.
IndexBox indexBoxOf(const WorldBox& world, const glm::dmat4& worldFromIndex) {
    const glm::dmat4 indexFromWorld = glm::inverse(worldFromIndex);
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? world.max.x : world.min.x,
                            corner & 2 ? world.max.y : world.min.y,
                            corner & 4 ? world.max.z : world.min.z);
        const glm::dvec3 index(indexFromWorld * glm::dvec4(at, 1));
        low = glm::min(low, index);
        high = glm::max(high, index);
    }
    const glm::dvec3 far(0x1p29);
    return {glm::ivec3(glm::clamp(glm::floor(low + kRounding), -far, far)),
            glm::ivec3(glm::clamp(glm::ceil(high - kRounding), -far, far))};
}

std::string keyOf(const std::filesystem::path& input, const ReadOptions& options) {
    return input.string() + (options.gridName ? '\n' + *options.gridName : "");
}

}  // namespace

double ValueCounts::rounded(double value, int bits) {
    if (bits == 52) return value;
    const std::uint64_t mask = ~((std::uint64_t{1} << (52 - bits)) - 1);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) & mask);
}

void ValueCounts::add(double value, std::uint64_t count) {
    // Mostly they come in order.
    counts_.emplace_hint(counts_.end(), rounded(value, bits_), 0)->second += count;
}

// Cutting off bits gives the same, whichever are cut off first, and keeps the order of values.
void ValueCounts::limit() {
    if (counts_.size() <= kMost) return;
    std::vector<double> values;
    values.reserve(counts_.size());
    for (const auto& [value, count] : counts_) values.push_back(value);
    const auto differentOnes = [&](int bits) {
        std::size_t count = 1;
        for (std::size_t i = 1; i < values.size(); ++i)
            if (rounded(values[i], bits) != rounded(values[i - 1], bits)) ++count;
        return count;
    };
    while (bits_ > 0 && differentOnes(bits_) > kMost) --bits_;
    std::map<double, std::uint64_t> fewer;
    for (const auto& [value, count] : counts_)
        fewer.emplace_hint(fewer.end(), rounded(value, bits_), 0)->second += count;
    counts_ = std::move(fewer);
}

double ValueCounts::relativeError() const {
    return bits_ == 52 ? 0 : std::ldexp(1.0, -bits_);
}

Volume SequenceLook::read(const std::filesystem::path& input, const ReadOptions& options,
                          const Listener& listener) {
    const std::string key = keyOf(input, options);
    if (isFinished_) {
        const std::lock_guard lock(mutex_);
        const auto known = kept_.find(key);
        if (known != kept_.end()) {
            for (const std::string& text : known->second.warnings) listener.warn(text);
            return known->second.volume;
        }
    }
    if (isFinished_) return readVolume(input, options, listener);
    std::vector<std::string> warnings;
    const Listener reading{listener.progress, [&](const std::string& text) {
                               warnings.push_back(text);
                               listener.warn(text);
                           }};
    Volume volume = readVolume(input, options, reading);
    const std::lock_guard lock(mutex_);
    const double bytes = bytesOf(volume);
    largestBytes_ = std::max(largestBytes_, bytes);
    if (bytes <= keptBytes_ && kept_.emplace(key, Kept{volume, std::move(warnings)}).second)
        keptBytes_ -= bytes;
    return volume;
}

void SequenceLook::note(std::size_t frame, const Volume& volume, Grid& grid) {
    // Frames come in any order; the first one tells what all share. An empty one knows little.
    const std::size_t order = volume.empty() ? kEmptyOrder + frame : frame;
    if (!grid.order || order < *grid.order) {
        grid.order = order;
        grid.first = volume.withoutVoxels();
    }
    if (volume.empty()) return;
    const WorldBox world = worldBox(volume.box(), volume.worldFromIndex());
    grid.box =
        grid.box ? WorldBox{glm::min(grid.box->min, world.min), glm::max(grid.box->max, world.max)}
                 : world;
    grid.least = grid.active == 0 ? volume.valueMin() : std::min(grid.least, volume.valueMin());
    grid.most = grid.active == 0 ? volume.valueMax() : std::max(grid.most, volume.valueMax());
    grid.active += volume.activeCount();
    ++grid.volumes;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] != 0)
            grid.values.add(volume.codeBook().valueOf(Code(code)), volume.histogram()[code]);
    }
    if (grid.volumes > 1) grid.values.limit();
    if (volume.mostFrequent())
        grid.mostFrequent[volume.mostFrequent()->value] += volume.mostFrequent()->count;
}

const Volume& SequenceLook::standIn(std::size_t frame, const std::string& grid,
                                    const Volume& volume) {
    const std::lock_guard lock(mutex_);
    if (isFinished_) {
        const auto whole = wholes_.find(grid);
        // A grid of some frames only, which the survey did not see.
        return whole == wholes_.end() ? volume : whole->second;
    }
    note(frame, volume, grids_[grid]);
    if (grid == kMainGrid) {
        const double voxel = smallestSize(volume);
        smallestVoxel_ = smallestVoxel_ > 0 ? std::min(smallestVoxel_, voxel) : voxel;
    }
    return volume;
}

void SequenceLook::addSeen(std::size_t frame, const Volume& volume) {
    if (isFinished_) return;
    const std::lock_guard lock(mutex_);
    note(frame, volume, seenGrid_);
}

// The first frame's grid with the values of all, and a box around all.
Volume SequenceLook::whole(const Grid& grid) {
    if (!grid.box) return grid.first;
    VolumeData volume = grid.first.data();
    volume.valueMin = grid.least;
    volume.valueMax = grid.most;
    volume.activeCount = grid.active;
    volume.box = indexBoxOf(*grid.box, volume.worldFromIndex);
    std::vector<double> values;
    volume.histogram.assign(kCodeCount, 0);
    for (const auto& [value, count] : grid.values.counts()) {
        volume.histogram[values.size()] = count;
        values.push_back(value);
    }
    volume.codeBook = CodeBook::ofTable(std::move(values));
    volume.codeBook.relativeError = grid.values.relativeError();
    volume.mostFrequent.reset();
    for (const auto& [value, count] : grid.mostFrequent) {
        if (!volume.mostFrequent || count > volume.mostFrequent->count)
            volume.mostFrequent = {value, count};
    }
    return Volume(std::move(volume));
}

void SequenceLook::finish() {
    for (const auto& [name, grid] : grids_) wholes_.emplace(name, whole(grid));
    seen_ = whole(seenGrid_);
    isFinished_ = true;
}

namespace {

using Json = nlohmann::ordered_json;

template <typename Map>
Json pairsJson(const Map& map) {
    Json pairs = Json::array();
    for (const auto& [value, count] : map) pairs.push_back({value, count});
    return pairs;
}

std::map<double, std::uint64_t> pairsOf(const Json& json) {
    std::map<double, std::uint64_t> map;
    for (const Json& pair : json) {
        const auto count = wholeNumberOf<std::uint64_t>(pair.at(1));
        if (count == 0) throw std::invalid_argument("values that none has");
        map[pair.at(0).get<double>()] = count;
    }
    return map;
}

Json matrixJson(const glm::dmat4& matrix) {
    Json columns = Json::array();
    for (int i = 0; i < 4; ++i)
        columns.push_back({matrix[i].x, matrix[i].y, matrix[i].z, matrix[i].w});
    return columns;
}

glm::dmat4 matrixOf(const Json& json) {
    glm::dmat4 matrix(1);
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) matrix[i][j] = json.at(std::size_t(i)).at(std::size_t(j));
    }
    return matrix;
}

Json vectorJson(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

glm::dvec3 vectorOf(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

Json SequenceLook::json(const Grid& grid) {
    const Volume& first = grid.first;
    Json json{{"name", first.name()},
              {"type", first.type()},
              {"class", first.gridClass()},
              {"from_level_set", first.fromLevelSet()},
              {"has_background", first.hasBackground()},
              {"background", first.background()},
              {"space", first.space()},
              {"world_from_index", matrixJson(first.worldFromIndex())},
              {"active", grid.active},
              {"range", {grid.least, grid.most}}};
    if (first.labels()) json["labels"] = labelText(*first.labels());
    if (grid.box) json["world_box"] = {vectorJson(grid.box->min), vectorJson(grid.box->max)};
    json["most_frequent"] = pairsJson(grid.mostFrequent);
    json["bits"] = grid.values.bits_;
    json["values"] = pairsJson(grid.values.counts_);
    return json;
}

SequenceLook::Grid SequenceLook::gridOf(const Json& json) {
    Grid grid;
    VolumeData first;
    json.at("name").get_to(first.name);
    json.at("type").get_to(first.type);
    json.at("class").get_to(first.gridClass);
    json.at("from_level_set").get_to(first.fromLevelSet);
    json.at("has_background").get_to(first.hasBackground);
    json.at("background").get_to(first.background);
    json.at("space").get_to(first.space);
    first.worldFromIndex = matrixOf(json.at("world_from_index"));
    if (json.contains("labels")) first.labels = labelsOfText(json.at("labels"));
    grid.active = wholeNumberOf<std::uint64_t>(json.at("active"));
    grid.least = json.at("range").at(0);
    grid.most = json.at("range").at(1);
    if (!(grid.least <= grid.most)) throw std::invalid_argument("range");
    if (json.contains("world_box")) {
        const Json& box = json.at("world_box");
        grid.box = WorldBox{vectorOf(box.at(0)), vectorOf(box.at(1))};
        if (!glm::all(glm::lessThanEqual(grid.box->min, grid.box->max)))
            throw std::invalid_argument("box");
    }
    grid.mostFrequent = pairsOf(json.at("most_frequent"));
    grid.values.bits_ = wholeNumberOf<int>(json.at("bits"));
    grid.values.counts_ = pairsOf(json.at("values"));
    const std::size_t values = grid.values.counts_.size();
    const int bits = grid.values.bits_;
    if (bits < 0 || bits > 52 || values > kCodeCount || (grid.box && values == 0))
        throw std::invalid_argument("values");
    requireInvertible(first.worldFromIndex);
    grid.first = Volume(std::move(first));
    return grid;
}

Json SequenceLook::toJson() const {
    Json grids = Json::object();
    for (const auto& [name, grid] : grids_) grids[name] = json(grid);
    Json look{{"smallest_voxel", smallestVoxel_}, {"seen", json(seenGrid_)}, {"grids", grids}};
    if (window_) look["window"] = {window_->x, window_->y};
    return look;
}

void SequenceLook::takeJson(const Json& json) {
    json.at("smallest_voxel").get_to(smallestVoxel_);
    constexpr double kLeast = 1e-30;  // as lengths of cameras
    const bool isLength = smallestVoxel_ >= kLeast && smallestVoxel_ <= 1 / kLeast;
    if (smallestVoxel_ != 0 && !isLength) throw std::invalid_argument("smallest_voxel");
    seenGrid_ = gridOf(json.at("seen"));
    for (const auto& [name, grid] : json.at("grids").items()) grids_[name] = gridOf(grid);
    if (json.contains("window")) {
        const glm::dvec2 window(json.at("window").at(0), json.at("window").at(1));
        if (!(window.x < window.y)) throw std::invalid_argument("window");
        window_ = window;
    }
    finish();
}

}  // namespace deltasplat
