// SPDX-License-Identifier: Apache-2.0
#include "words/pack_columns.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace deltasplat {
namespace {

constexpr BlockClasses kNothing{};

// Prefetches the codes of the next block, and the leaf after it.
void fetchAhead(const CodeBlock* next, const CodeBlock* end) {
    if (next == end) return;
    if (next + 1 < end) hwy::Prefetch(next[1].leaf);
    if (next->leaf) fetchCodes(*next->leaf);
}

// Sorts words by parts along v.
void sortParts(std::vector<PendingWord>& words, std::size_t first) {
    std::stable_partition(words.begin() + std::ptrdiff_t(first), words.end(),
                          [](const PendingWord& word) { return word.block.y % 2 == 0; });
}

// Sorts a row's words by column, so that words of a block are neighbours.
void groupByColumn(std::vector<PendingWord>& words, std::size_t first) {
    std::array<std::vector<PendingWord>, std::size_t(kTileColumns.y)> columns;
    for (std::size_t i = first; i < words.size(); ++i)
        columns[std::size_t(words[i].block.y & (kTileColumns.y - 1))].push_back(words[i]);
    words.resize(first);
    for (const std::vector<PendingWord>& column : columns)
        words.insert(words.end(), column.begin(), column.end());
}

std::vector<std::size_t> wordsOf(WordWriter& writer) {
    std::vector<std::size_t> words;
    for (const PackedColumns& packed : writer.rows()) words.push_back(packed.words.size());
    return words;
}

class TilePacker {
  public:
    TilePacker(const JoinedTiles& tiles, const SliceJoiner& joiner, bool descending,
               WordWriter& writer)
        : columns_(tiles.columns()),
          joiner_(joiner),
          descending_(descending),
          writer_(writer),
          last_(std::size_t(columns_.x) * std::size_t(columns_.y)) {}

    // Adds the words of a tile in slice order. Within a row and slice, words are ordered by v.
    void pack(JoinedTileReader& reader, const JoinedTile& tile) {
        tile_ = tile;
        std::fill(last_.begin(), last_.end(), kNever);
        writer_.beginColumns();
        const std::vector<std::size_t> firstWords = wordsOf(writer_);
        int place = kNever;
        // With too many looks the result is discarded.
        while (!joiner_.hasTooManyLooks() && reader.next()) {
            if (place != kNever && place + 1 < reader.place()) endAll(place + 1);
            place = reader.place();
            for (std::size_t column = 0; column < last_.size(); ++column) {
                if (!reader.has(column)) {
                    endBefore(column, place);
                    continue;
                }
                add(reader.classes(column), column, place, writer_.range().layout.slicesOf(place));
                last_[column] = place;
            }
        }
        if (place != kNever) endAll(place + 1);
        if (!descending_) return;
        for (std::size_t u = 0; u < firstWords.size(); ++u)
            groupByColumn(writer_.rows()[u].words, firstWords[u]);
    }

  private:
    static constexpr int kNever = std::numeric_limits<int>::min();

    void add(const BlockClasses& classes, std::size_t column, int place, int slices) {
        const std::size_t u = column / std::size_t(columns_.y);
        const std::size_t v = column % std::size_t(columns_.y);
        const glm::ivec2 at = tile_ * columns_ + glm::ivec2(u, v);
        writer_.add(classes, nullptr, {place, at}, column, u, slices);
    }
    // The slice behind a block removes its voxels.
    void endBefore(std::size_t column, int place) {
        if (last_[column] == kNever || last_[column] != place - 1 ||
            place > writer_.range().lastBlock)
            return;
        add(kNothing, column, place, 1);
    }
    void endAll(int place) {
        for (std::size_t column = 0; column < last_.size(); ++column) endBefore(column, place);
    }

    glm::ivec2 columns_;
    const SliceJoiner& joiner_;
    bool descending_;
    WordWriter& writer_;
    JoinedTile tile_{0};
    std::vector<int> last_;  // [column]: place of its last block
};

}  // namespace

void packColumns(const Columns& columns, BlockSource& source, WordWriter& writer,
                 std::vector<PackedColumns>& room) {
    const DividedBlock& divided = source.divided();
    const Subdivision& parts = divided.parts;
    const PackRange& range = writer.range();
    // Mixing reads neighbouring slices, so a mixed column is always read whole, never slab by slab.
    const auto isIn = [&](const CodeBlock& block) {
        return source.readsAround() || range.contains(block.position.x);
    };
    writer.begin(std::size_t(parts.within), room);
    const auto blocks = std::size_t(std::count_if(columns.begin, columns.end, isIn));
    for (std::size_t half = 0; half < writer.rows().size(); ++half)
        writer.reserve(half, kMostWordsOfBlock * std::size_t(parts.slices) *
                                 std::size_t(parts.within) * blocks);
    std::vector<std::size_t> firstWords;  // [half]: first word of the column
    for (const CodeBlock* block = columns.begin; block != columns.end; ++block) {
        if (!isIn(*block)) continue;
        const bool isFirst =
            block == columns.begin || !follows(block[-1], *block) || !isIn(block[-1]);
        const bool isLast = block + 1 == columns.end || !follows(*block, block[1]);
        if (isFirst) {
            writer.beginColumns();
            source.beginColumn();
            firstWords = wordsOf(writer);
        }
        if (!source.readsAround()) fetchAhead(block + 1, columns.end);
        source.read(*block, writer);
        if (!isLast) continue;
        // The slice behind a block removes its voxels.
        const glm::ivec3 first = divided.first(*block);
        const int next = first.x + parts.slices;
        if (next <= range.lastBlock) {
            divided.forParts([&](const glm::ivec2& part) {
                writer.add(kNothing, source.looks(), {next, first.y + part.x, first.z + part.y},
                           DividedBlock::numberOf(part), std::size_t(part.x), 1);
            });
        }
        writer.payForWords();
        if (parts.within == 1) continue;
        for (std::size_t half = 0; half < writer.rows().size(); ++half)
            sortParts(writer.rows()[half].words, firstWords[half]);
    }
    writer.finish(room);
}

void packTiles(const JoinedTiles& tiles, std::size_t run, const ClassReader& classes,
               const SliceJoiner& joiner, bool descending, WordWriter& writer,
               std::vector<PackedColumns>& room) {
    writer.begin(std::size_t(tiles.columns().x), room);
    const PackRange& range = writer.range();
    std::vector<TileSources> sources;
    for (const JoinedTile& tile : tiles.runs()[run]) sources.push_back(tiles.sourcesOf(tile));
    for (std::size_t u = 0; range.storesWords && u < writer.rows().size(); ++u) {
        std::size_t blocks = 0;
        for (const TileSources& ofTile : sources)
            blocks += tiles.mostBlocks(ofTile, int(u), range.firstBlock, range.lastBlock);
        writer.reserve(u, kMostWordsOfBlock * blocks);
    }
    JoinedTileReader reader(classes, joiner, tiles);
    TilePacker packer(tiles, joiner, descending, writer);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        reader.begin(sources[i], range.firstBlock, range.lastBlock);
        packer.pack(reader, tiles.runs()[run][i]);
        writer.payForWords();
    }
    writer.finish(room);
}

}  // namespace deltasplat
