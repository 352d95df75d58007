// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/common.hpp>
#include <limits>
#include <tuple>

#include "floor_div.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

bool isBefore(const glm::ivec2& a, const glm::ivec2& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

JoinedTile tileOf(const glm::ivec2& column) {
    return {floorDiv(column.x, kTileColumns.x), floorDiv(column.y, kTileColumns.y)};
}

// Returns which columns those of so many voxels side by side are read from, counted from the first.
ColumnRange columnsReadFor(std::span<const glm::ivec2> slants, int voxels) {
    glm::ivec2 down = slants.front();
    glm::ivec2 up = slants.front();
    for (const glm::ivec2& slant : slants) {
        down = glm::min(down, slant);
        up = glm::max(up, slant);
    }
    // What is moved up comes from a column before.
    const glm::ivec2 first(floorDiv(-up.x, 8), floorDiv(-up.y, 8));
    const glm::ivec2 last(floorDiv(voxels - 1 - down.x, 8), floorDiv(voxels - 1 - down.y, 8));
    return {first, last - first + 1};
}

using PartCounts = std::array<std::size_t, kMostJoined / 8>;

// Returns how many blocks of a column there are of each of so many that follow each other.
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
    // A run has a share of all blocks, and no more than a row of tiles.
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
            // Of a row of columns most are in the tile of the one before.
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
    std::vector<PartCounts> counts;  // [u][v], of the columns that these are made of
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

}  // namespace deltasplat
