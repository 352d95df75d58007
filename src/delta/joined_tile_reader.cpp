// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_tile_reader.h"

#include <algorithm>
#include <limits>

#include "delta/fetch_codes.h"

namespace deltasplat {
namespace {

constexpr std::size_t kSlice = 64;  // of a block
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
    // Of 8 slices of joined ones.
    const int layers = (1 << tiles_.shift()) / int(isFilled_.size());
    for (int layer = 0; layer < layers; ++layer)
        if (readLayer(place_ * layers + layer)) joinLayer(layer);
    return true;
}

// Reads the blocks of a layer, of which there is one after the other along the slices. Returns
// whether there are any.
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

// Brings what will be read soon nearer.
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

// Of the layer's voxel, where it is.
std::ptrdiff_t JoinedTileReader::placeOf(std::size_t slice, const glm::ivec2& at) const {
    return (std::ptrdiff_t(slice) * voxels_.x + at.x) * voxels_.y + at.y;
}

// Returns where a source column's first voxel is in the layer.
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

// Joins the slices of the layer in hand, a part of those that blocks at this place have.
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
        // Two and two, for so they are joined; pairs in which nothing is are left out.
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
        if (count == 0) continue;  // it is clear
        joiner_.join(std::span(slices).first(count), std::size_t(voxels_.y), slice,
                     &out[kSlice * slice], cache_);
    }
}

// Whether there may be anything in the layer's voxels from a place on that become 8x8.
bool JoinedTileReader::mayHave(std::size_t slice, const glm::ivec2& first) const {
    const std::bitset<TileSources::kCount>& isFilled = isFilled_[slice / kSlices];
    const glm::ivec2 last = first + 8 * tiles_.within() - 1;
    for (int u = first.x >> 3; u <= last.x >> 3; ++u)
        for (int v = first.y >> 3; v <= last.y >> 3; ++v)
            if (isFilled[TileSources::numberOf(u, v)]) return true;
    return false;
}

}  // namespace deltasplat
