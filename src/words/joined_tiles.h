// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"
#include "words/class_reader.h"
#include "words/slice_joiner.h"

namespace deltasplat {

/// A rectangle of kTileColumns columns of blocks (same u and v), and what their joined slices
/// become: the place (u, v) of its first one is this times JoinedTiles::columns().
using JoinedTile = glm::ivec2;

inline constexpr glm::ivec2 kTileColumns{8, 16};

/// The blocks that a tile's columns are made of, before slices are joined: of columns [u][v], some
/// more than the tile has, for slants reach into neighbours. Empty where there are none.
struct TileSources {
    static constexpr glm::ivec2 kColumns = kTileColumns + kMostJoined / 8;

    static constexpr std::size_t kCount = std::size_t{kColumns.x} * kColumns.y;

    std::array<std::span<const CodeBlock>, kCount> columns;

    /// Returns the number of a column.
    static constexpr std::size_t numberOf(int u, int v) {
        return std::size_t(u) * kColumns.y + std::size_t(v);
    }
    std::span<const CodeBlock>& at(int u, int v) { return columns[numberOf(u, v)]; }
    const std::span<const CodeBlock>& at(int u, int v) const { return columns[numberOf(u, v)]; }
};

/// Columns along u and v: the first of several, and how many there are.
struct ColumnRange {
    glm::ivec2 first;
    glm::ivec2 count;
};

/// Where there are columns of joined slices, and what they are made of. Slices n * i to n * i + n -
/// 1 become one, each moved by a slant of its own, and then w x w voxels of it.
class JoinedTiles {
  public:
    /// @param blocks  ordered by u, v and slice; must outlive this
    /// @param slants  [n, a power of two]: as Subdivision::joinedSlants
    /// @param within  w, as Subdivision::joinedWithin
    JoinedTiles(const std::vector<CodeBlock>& blocks, std::span<const glm::ivec2> slants,
                int within = 1);

    /// The tiles in which there may be anything, ordered by u, then v: in runs of neighbours along
    /// v, which are one task each.
    const std::vector<std::vector<JoinedTile>>& runs() const { return runs_; }
    std::span<const glm::ivec2> slants() const { return slants_; }
    /// The power of two that slices are joined by.
    int shift() const { return shift_; }
    /// How many voxels beside each other become one, along u and along v.
    int within() const { return within_; }
    /// How many columns a tile has, of what slices become.
    glm::ivec2 columns() const { return kTileColumns / within_; }
    /// How many columns of sources there are at most: no more than TileSources::kColumns.
    glm::ivec2 sourceColumns() const { return kTileColumns - within_ + sources_; }
    /// Of the sources, where those of the tile's first column begin in the first slice.
    const glm::ivec2& own() const { return own_; }
    /// How many blocks one behind the other have slices that become one.
    std::size_t partCount() const { return ofFirst_.size(); }
    /// Of so many blocks, which sources column (0, 0) is made of as far as one of them goes.
    const ColumnRange& sourcesOfFirst(std::size_t part) const { return ofFirst_[part]; }

    TileSources sourcesOf(const JoinedTile& tile) const;
    /// Returns the most blocks of joined slices that a tile's columns of the same u can have.
    std::size_t mostBlocks(const TileSources& sources, int u, int firstPlace, int lastPlace) const;
    /// The same of all tiles together, whatever their place.
    std::size_t mostBlocks() const { return mostBlocks_; }

  private:
    std::vector<JoinedTile> listTiles() const;
    glm::ivec2 placeOf(std::size_t column) const;

    std::span<const CodeBlock> blocks_;
    std::vector<glm::ivec2> slants_;
    std::vector<ColumnRange> ofFirst_;
    std::vector<std::size_t> begins_;  // of columns, and the number of all blocks
    int shift_;
    int within_;
    glm::ivec2 own_{0};
    glm::ivec2 sources_{1};  // how many columns one is made of
    std::vector<std::vector<JoinedTile>> runs_;
    std::size_t mostBlocks_ = 0;
};

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

/// Whether two slices of voxels of these classes can be joined for steps of any length: all have
/// one colour, for then it does not matter which is in front, or there are few enough for pairs of
/// them to be numbered.
bool canBePaired(const ClassTable& classes);

/// What becomes one.
struct JoinedRun {
    int slices;
    int within;               ///< as Subdivision::joinedWithin
    SeenThrough seenThrough;  ///< of two that follow each other, which is behind
    double steps;             ///< how many times as long as those of the classes steps are
};

/// Returns what each class looks like over a step, premultiplied; black where all have one colour.
std::vector<glm::dvec4> lightsOf(const ClassTable& classes);

/// Returns what joins slices: for steps of any length if they are of one colour, or two that can be
/// paired, and no more than slices is joined.
SliceJoiner joinerOf(const ClassTable& classes, const JoinedRun& run);

/// Returns the classes that voxels of joined slices have, once these are joined.
ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         const JoinedRun& run);

}  // namespace deltasplat
