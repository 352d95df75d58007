// SPDX-License-Identifier: Apache-2.0
#include "words/joined_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <tuple>
#include <vector>

#include "base/bits.h"
#include "base/portable_math.h"
#include "base/sorting.h"
#include "volume/code_blocks.h"

namespace deltasplat {

namespace {

bool isBefore(const glm::ivec2& a, const glm::ivec2& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

JoinedTile tileOf(const glm::ivec2& column) {
    return {floorDiv(column.x, kTileColumns.x), floorDiv(column.y, kTileColumns.y)};
}

// Returns the columns that `voxels` neighbouring voxels are read from, relative to their first.
ColumnRange columnsReadFor(std::span<const glm::ivec2> slants, int voxels) {
    glm::ivec2 down = slants.front();
    glm::ivec2 up = slants.front();
    for (const glm::ivec2& slant : slants) {
        down = glm::min(down, slant);
        up = glm::max(up, slant);
    }
    // Voxels that move up come from an earlier column.
    const glm::ivec2 first(floorDiv(-up.x, 8), floorDiv(-up.y, 8));
    const glm::ivec2 last(floorDiv(voxels - 1 - down.x, 8), floorDiv(voxels - 1 - down.y, 8));
    return {first, last - first + 1};
}

using PartCounts = std::array<std::size_t, kMostJoined / 8>;

// Counts the blocks of a column per part.
PartCounts countParts(std::span<const CodeBlock> column, std::size_t parts) {
    PartCounts counts{};
    if (parts == 1) {
        counts[0] = column.size();
        return counts;
    }
    for (const CodeBlock& block : column) ++counts[std::size_t(block.position.x) & (parts - 1)];
    return counts;
}

}  // namespace

JoinedTiles::JoinedTiles(const std::vector<CodeBlock>& blocks, std::span<const glm::ivec2> slants,
                         int within)
    : blocks_(blocks),
      slants_(slants.begin(), slants.end()),
      begins_(runBegins(blocks, shareColumn)),
      shift_(int(std::bit_width(slants.size())) - 1),
      within_(within) {
    const ColumnRange ofColumn = columnsReadFor(slants_, 8 * within);
    own_ = -ofColumn.first;
    sources_ = ofColumn.count;
    for (std::size_t slice = 0; slice < slants.size(); slice += 8) {
        const std::size_t count = std::min<std::size_t>(slants.size(), 8);
        const ColumnRange ofPart = columnsReadFor(slants.subspan(slice, count), 8 * within);
        ofFirst_.push_back({own_ + ofPart.first, ofPart.count});
    }
    // A run has at least this many blocks, but stays within a row of tiles.
    const std::size_t least = std::max<std::size_t>(256, blocks.size() / 256);
    constexpr int kAny = std::numeric_limits<int>::max() >> 3;
    std::size_t inRun = least;
    for (const JoinedTile& tile : listTiles()) {
        if (inRun >= least || runs_.back().back().x != tile.x) {
            runs_.emplace_back();
            inRun = 0;
        }
        runs_.back().push_back(tile);
        const TileSources sources = sourcesOf(tile);
        for (const std::span<const CodeBlock>& column : sources.columns) inRun += column.size();
        for (int u = 0; u < columns().x; ++u) mostBlocks_ += mostBlocks(sources, u, -kAny, kAny);
    }
}

glm::ivec2 JoinedTiles::placeOf(std::size_t column) const {
    const glm::ivec3& position = blocks_[begins_[column]].position;
    return {position.y, position.z};
}

std::vector<JoinedTile> JoinedTiles::listTiles() const {
    std::vector<JoinedTile> tiles;
    for (int u = 0; u < sources_.x; ++u) {
        for (int v = 0; v < sources_.y; ++v) {
            // Neighbouring columns are mostly in the same tile.
            for (std::size_t column = 0; column + 1 < begins_.size(); ++column) {
                const JoinedTile tile = tileOf(placeOf(column) + own_ - glm::ivec2(u, v));
                if (tiles.empty() || tiles.back() != tile) tiles.push_back(tile);
            }
        }
    }
    std::sort(tiles.begin(), tiles.end(), isBefore);
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    return tiles;
}

TileSources JoinedTiles::sourcesOf(const JoinedTile& tile) const {
    TileSources sources;
    const glm::ivec2 first = tile * kTileColumns - own_;
    const std::size_t columns = begins_.size() - 1;
    const glm::ivec2 count = sourceColumns();
    for (int u = 0; u < count.x; ++u) {
        const glm::ivec2 begin = first + glm::ivec2(u, 0);
        const auto found = std::lower_bound(
            begins_.begin(), begins_.begin() + std::ptrdiff_t(columns), begin,
            [&](std::size_t of, const glm::ivec2& place) {
                return isBefore({blocks_[of].position.y, blocks_[of].position.z}, place);
            });
        for (auto c = std::size_t(found - begins_.begin()); c < columns; ++c) {
            const glm::ivec2 at = placeOf(c) - begin;
            if (at.x != 0 || at.y >= count.y) break;
            sources.at(u, at.y) = blocks_.subspan(begins_[c], begins_[c + 1] - begins_[c]);
        }
    }
    return sources;
}

std::size_t JoinedTiles::mostBlocks(const TileSources& sources, int u, int firstPlace,
                                    int lastPlace) const {
    std::vector<PartCounts> counts;  // [u][v]: of source columns
    for (int i = 0; i < sources_.x; ++i)
        for (int v = 0; v < TileSources::kColumns.y; ++v)
            counts.push_back(countParts(sources.at(within_ * u + i, v), partCount()));
    std::size_t most = 0;
    for (int v = 0; v < columns().y; ++v) {
        std::size_t count = 0;
        int first = lastPlace + 1;
        int last = firstPlace - 1;
        const auto add = [&](std::size_t part, const glm::ivec2& at) {
            const std::span<const CodeBlock> column = sources.at(within_ * u + at.x, at.y);
            const std::size_t blocks = counts[TileSources::numberOf(at.x, at.y)][part];
            if (blocks == 0) return;
            count += blocks;
            first = std::min(first, column.front().position.x >> shift_);
            last = std::max(last, column.back().position.x >> shift_);
        };
        for (std::size_t part = 0; part < partCount(); ++part) {
            const ColumnRange& from = ofFirst_[part];
            for (int i = 0; i < from.count.x; ++i)
                for (int j = 0; j < from.count.y; ++j)
                    add(part, from.first + glm::ivec2(i, within_ * v + j));
        }
        first = std::max(first, firstPlace);
        last = std::min(last, lastPlace);
        if (first <= last) most += std::min(count, std::size_t(last - first) + 1);
    }
    return most;
}

namespace {

constexpr std::size_t kSlice = 64;  // voxels of a block's slice
constexpr std::size_t kSlices = 8;

}  // namespace

JoinedTileReader::JoinedTileReader(const ClassReader& classes, const SliceJoiner& joiner,
                                   const JoinedTiles& tiles)
    : classReader_(classes),
      joiner_(joiner),
      tiles_(tiles),
      columns_(tiles.columns()),
      isFilled_(tiles.partCount()),
      sourceCount_(TileSources::numberOf(tiles.sourceColumns().x, 0)),
      voxels_(8 * tiles.sourceColumns()),
      layer_(kSlices * isFilled_.size() * std::size_t(voxels_.x) * std::size_t(voxels_.y)),
      joined_(std::size_t(columns_.x) * std::size_t(columns_.y)) {}

void JoinedTileReader::begin(const TileSources& sources, int firstPlace, int lastPlace) {
    rest_ = sources;
    lastPlace_ = lastPlace;
    for (std::span<const CodeBlock>& column : rest_.columns) {
        const auto first =
            std::partition_point(column.begin(), column.end(), [&](const CodeBlock& block) {
                return block.position.x >> tiles_.shift() < firstPlace;
            });
        column = column.subspan(std::size_t(first - column.begin()));
    }
}

bool JoinedTileReader::next() {
    constexpr int kNone = std::numeric_limits<int>::max();
    place_ = kNone;
    for (std::size_t column = 0; column < sourceCount_; ++column) {
        const std::span<const CodeBlock>& blocks = rest_.columns[column];
        if (!blocks.empty()) place_ = std::min(place_, blocks.front().position.x >> tiles_.shift());
    }
    if (place_ > lastPlace_) return false;
    has_.reset();
    // Number of layers in eight joined slices.
    const int layers = (1 << tiles_.shift()) / int(isFilled_.size());
    for (int layer = 0; layer < layers; ++layer)
        if (readLayer(place_ * layers + layer)) joinLayer(layer);
    return true;
}

// Reads the blocks of a layer. Returns whether there are any.
bool JoinedTileReader::readLayer(int layer) {
    bool hasAny = false;
    for (std::size_t part = 0; part < isFilled_.size(); ++part)
        hasAny = readPart(part, layer * int(isFilled_.size()) + int(part)) || hasAny;
    return hasAny;
}

bool JoinedTileReader::readPart(std::size_t part, int position) {
    std::bitset<TileSources::kCount>& isFilled = isFilled_[part];
    for (std::size_t column = 0; column < sourceCount_; ++column) {
        std::span<const CodeBlock>& blocks = rest_.columns[column];
        if (!blocks.empty() && blocks.front().position.x == position) {
            fetchAhead(column);
            readBlock(part, column, blocks.front());
            blocks = blocks.subspan(1);
            isFilled.set(column);
        } else if (isFilled[column]) {
            clearBlock(part, column);
            isFilled.reset(column);
        }
    }
    return isFilled.any();
}

// Prefetches blocks that are read soon.
void JoinedTileReader::fetchAhead(std::size_t column) const {
    constexpr std::size_t kLeafAhead = 6;
    constexpr std::size_t kCodesAhead = 2;
    const auto leafOf = [&](std::size_t of) -> const CodeTree::Leaf* {
        const bool isThere = of < rest_.columns.size() && !rest_.columns[of].empty();
        return isThere ? rest_.columns[of].front().leaf : nullptr;
    };
    if (const CodeTree::Leaf* leaf = leafOf(column + kLeafAhead)) hwy::Prefetch(leaf);
    if (const CodeTree::Leaf* leaf = leafOf(column + kCodesAhead)) fetchCodes(*leaf);
}

std::ptrdiff_t JoinedTileReader::placeOf(std::size_t slice, const glm::ivec2& at) const {
    return (std::ptrdiff_t(slice) * voxels_.x + at.x) * voxels_.y + at.y;
}

ClassIndex* JoinedTileReader::rowsOf(std::size_t part, std::size_t column) {
    const auto u = int(column) / TileSources::kColumns.y;
    const auto v = int(column) % TileSources::kColumns.y;
    return layer_.data() + placeOf(kSlices * part, {8 * u, 8 * v});
}

void JoinedTileReader::readBlock(std::size_t part, std::size_t column, const CodeBlock& block) {
    BlockClasses classes;
    classReader_.read(block, std::span(classes));
    ClassIndex* const rows = rowsOf(part, column);
    for (std::size_t slice = 0; slice < kSlices; ++slice)
        for (int u = 0; u < 8; ++u)
            std::copy_n(&classes[kSlice * slice + 8 * std::size_t(u)], 8,
                        rows + placeOf(slice, {u, 0}));
}

void JoinedTileReader::clearBlock(std::size_t part, std::size_t column) {
    ClassIndex* const rows = rowsOf(part, column);
    for (std::size_t slice = 0; slice < kSlices; ++slice)
        for (int u = 0; u < 8; ++u) std::fill_n(rows + placeOf(slice, {u, 0}), 8, ClassIndex{0});
}

// Joins the slices of the current layer.
void JoinedTileReader::joinLayer(int layer) {
    for (int u = 0; u < columns_.x; ++u) {
        for (int v = 0; v < columns_.y; ++v) {
            if (!hasSources(u, v)) continue;
            const std::size_t column = std::size_t(u) * std::size_t(columns_.y) + std::size_t(v);
            if (!has_[column]) joined_[column].fill(0);
            has_.set(column);
            joinBlock(u, v, layer, joined_[column]);
        }
    }
}

bool JoinedTileReader::hasSources(int u, int v) const {
    for (std::size_t part = 0; part < isFilled_.size(); ++part) {
        const ColumnRange& sources = tiles_.sourcesOfFirst(part);
        const glm::ivec2 first = sources.first + tiles_.within() * glm::ivec2(u, v);
        for (int i = 0; i < sources.count.x; ++i)
            for (int j = 0; j < sources.count.y; ++j)
                if (isFilled_[part][TileSources::numberOf(first.x + i, first.y + j)]) return true;
    }
    return false;
}

void JoinedTileReader::joinBlock(int u, int v, int layer, BlockClasses& out) {
    const std::span<const glm::ivec2> slants = tiles_.slants();
    const std::size_t joined = kSlices * isFilled_.size() / slants.size();
    const glm::ivec2 first = 8 * (tiles_.within() * glm::ivec2(u, v) + tiles_.own());
    std::array<const ClassIndex*, kMostJoined> slices;
    for (std::size_t i = 0; i < joined; ++i) {
        std::size_t count = 0;
        // Slices are joined in pairs; empty pairs are left out.
        for (std::size_t k = 0; k < slants.size(); k += 2) {
            const std::size_t place = i * slants.size() + k;
            const glm::ivec2 nearer = first - slants[k];
            const glm::ivec2 farther = first - slants[k + 1];
            if (slants.size() > 2 && !mayHave(place, nearer) && !mayHave(place + 1, farther))
                continue;
            slices[count++] = layer_.data() + placeOf(place, nearer);
            slices[count++] = layer_.data() + placeOf(place + 1, farther);
        }
        const std::size_t slice = std::size_t(layer) * joined + i;
        if (count == 0) continue;  // nothing is visible
        joiner_.join(std::span(slices).first(count), std::size_t(voxels_.y), slice,
                     &out[kSlice * slice], cache_);
    }
}

// Whether the 8x8 joined voxels from a place on may have sources in the layer.
bool JoinedTileReader::mayHave(std::size_t slice, const glm::ivec2& first) const {
    const std::bitset<TileSources::kCount>& isFilled = isFilled_[slice / kSlices];
    const glm::ivec2 last = first + 8 * tiles_.within() - 1;
    for (int u = first.x >> 3; u <= last.x >> 3; ++u)
        for (int v = first.y >> 3; v <= last.y >> 3; ++v)
            if (isFilled[TileSources::numberOf(u, v)]) return true;
    return false;
}

namespace {

// Whether only absorption distinguishes classes.
bool areSummed(const ClassTable& classes) {
    return classes.oneColor || classes.looks.size() == 1;
}

// Returns the look that gives this light over a step of the classes.
Look lookOf(const glm::dvec4& light, const ClassTable& classes) {
    const double unitDistances =
        classes.extinctionScale * (classes.stepWorld / classes.unitDistanceWorld);
    const double extinction = light.a < 1 ? -portable::log1p(-light.a) / unitDistances
                                          : std::numeric_limits<double>::infinity();
    return {light.a > 0 ? extinction : 0, glm::dvec3(light)};
}

}  // namespace

std::vector<glm::dvec4> lightsOf(const ClassTable& classes) {
    std::vector<glm::dvec4> lights;
    const std::vector<double> alphas = classes.alphas();
    const double colored = areSummed(classes) ? 0 : 1;
    for (std::size_t i = 0; i < alphas.size(); ++i)
        lights.emplace_back(colored * alphas[i] * classes.looks[i].color, alphas[i]);
    return lights;
}

bool canBePaired(const ClassTable& classes) {
    return areSummed(classes) || classes.size() * classes.size() <= ClassTable::kMaxClasses;
}

SliceJoiner joinerOf(const ClassTable& classes, const JoinedRun& run) {
    if (areSummed(classes) && run.within == 1) {
        std::vector<double> extinctions;
        for (const Look& look : classes.looks) extinctions.push_back(look.extinction);
        return SliceJoiner::ofSums(extinctions, run.slices);
    }
    if (run.slices == 2 && canBePaired(classes)) return SliceJoiner::ofPairs(classes.size());
    return SliceJoiner::ofLooks(lightsOf(classes.atSteps(run.steps)),
                                {.slices = run.slices,
                                 .lastInFront = run.seenThrough == SeenThrough::kFirst,
                                 .within = run.within});
}

ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         const JoinedRun& run) {
    ClassTable joined = classes;
    if (joiner.looks()) {
        joined = classes.atSteps(run.steps);
        joined.looks.clear();
        for (const glm::dvec4& light : joiner.looks()->looks()) {
            joined.looks.push_back(lookOf(light, joined));
            if (areSummed(classes)) joined.looks.back().color = classes.looks.back().color;
        }
        return joined.atSteps(1);
    }
    if (areSummed(classes)) {
        joined.looks.clear();
        for (const double extinction : joiner.levels())
            joined.looks.push_back({extinction, classes.looks.back().color});
    } else {
        joined.pairs = run.seenThrough;
    }
    return joined.atSteps(run.steps);
}

}  // namespace deltasplat
