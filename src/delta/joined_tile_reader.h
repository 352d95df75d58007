// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <span>
#include <vector>

#include "delta/class_reader.h"
#include "delta/joined_tiles.h"
#include "delta/slice_joiner.h"

namespace deltasplat {

/// Reads what the voxels of joined slices are, from the first block of a tile's columns to the
/// last. Every block is read once for a tile, with those around it at hand.
class JoinedTileReader {
  public:
    /// Most columns that a tile has.
    static constexpr std::size_t kColumns = std::size_t{kTileColumns.x} * kTileColumns.y;
    using BlockClasses = std::array<ClassIndex, 512>;

    /// @param classes,joiner,tiles  must outlive this
    JoinedTileReader(const ClassReader& classes, const SliceJoiner& joiner,
                     const JoinedTiles& tiles);

    /// Takes on a tile, before whose first block in [firstPlace, lastPlace] it stands then.
    void begin(const TileSources& sources, int firstPlace, int lastPlace);
    /// Goes on to the next place along the slices at which there are blocks. Returns whether there
    /// is one.
    bool next();
    int place() const { return place_; }
    /// How many columns a tile has, as JoinedTiles says.
    const glm::ivec2& columns() const { return columns_; }
    /// Whether a column, `[u][v]`, has a block at this place.
    bool has(std::size_t column) const { return has_[column]; }
    /// Returns what it is, `[slice][u][v]`.
    const BlockClasses& classes(std::size_t column) const { return joined_[column]; }

  private:
    bool readLayer(int layer);
    bool readPart(std::size_t part, int position);
    void readBlock(std::size_t part, std::size_t column, const CodeBlock& block);
    void clearBlock(std::size_t part, std::size_t column);
    ClassIndex* rowsOf(std::size_t part, std::size_t column);
    std::ptrdiff_t placeOf(std::size_t slice, const glm::ivec2& at) const;
    void fetchAhead(std::size_t column) const;
    void joinLayer(int layer);
    bool hasSources(int u, int v) const;
    void joinBlock(int u, int v, int layer, BlockClasses& out);
    bool mayHave(std::size_t slice, const glm::ivec2& first) const;

    const ClassReader& classReader_;
    const SliceJoiner& joiner_;
    const JoinedTiles& tiles_;
    glm::ivec2 columns_;  // of what slices become
    TileSources rest_;    // blocks that are still to come
    int lastPlace_ = 0;
    int place_ = 0;
    // The fewest blocks one behind the other of which slices become whole ones, of every source
    // column: [slice][u][v].
    std::vector<std::bitset<TileSources::kCount>> isFilled_;  // [part][column]
    std::size_t sourceCount_;                                 // columns behind these have no blocks
    glm::ivec2 voxels_;                                       // of a slice of them
    std::vector<ClassIndex> layer_;
    std::vector<BlockClasses> joined_;  // [column]
    std::bitset<kColumns> has_;
    LookCache cache_;
};

}  // namespace deltasplat
