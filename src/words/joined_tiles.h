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

/// A rectangle of kTileColumns columns of blocks (same u and v) and the columns they are joined to.
/// The first joined column is at (u, v) = tile * JoinedTiles::columns().
using JoinedTile = glm::ivec2;

inline constexpr glm::ivec2 kTileColumns{8, 16};

/// The columns of blocks that a tile is joined from, some empty. Slants reach into neighbours.
struct TileSources {
    static constexpr glm::ivec2 kColumns = kTileColumns + kMostJoined / 8;

    static constexpr std::size_t kCount = std::size_t{kColumns.x} * kColumns.y;

    std::array<std::span<const CodeBlock>, kCount> columns;

    static constexpr std::size_t numberOf(int u, int v) {
        return std::size_t(u) * kColumns.y + std::size_t(v);
    }
    std::span<const CodeBlock>& at(int u, int v) { return columns[numberOf(u, v)]; }
    const std::span<const CodeBlock>& at(int u, int v) const { return columns[numberOf(u, v)]; }
};

/// A rectangle of columns along u and v.
struct ColumnRange {
    glm::ivec2 first;
    glm::ivec2 count;
};

/// The columns of joined slices and their sources. Slices n * i to n * i + n - 1 are joined, each
/// moved by its own slant, and then w x w voxels of the result.
class JoinedTiles {
  public:
    /// @param blocks  ordered by u, v and slice; must outlive this object
    /// @param slants  [n, a power of two]: as Subdivision::joinedSlants
    /// @param within  w, as Subdivision::joinedWithin
    JoinedTiles(const std::vector<CodeBlock>& blocks, std::span<const glm::ivec2> slants,
                int within = 1);

    /// The tiles that may have voxels, ordered by u, then v. Each run along v is one task.
    const std::vector<std::vector<JoinedTile>>& runs() const { return runs_; }
    std::span<const glm::ivec2> slants() const { return slants_; }
    /// Log2 of the number of slices that are joined.
    int shift() const { return shift_; }
    /// Number of neighbouring voxels that are joined, along u and along v.
    int within() const { return within_; }
    /// Number of joined columns in a tile.
    glm::ivec2 columns() const { return kTileColumns / within_; }
    /// Largest number of source columns, at most TileSources::kColumns.
    glm::ivec2 sourceColumns() const { return kTileColumns - within_ + sources_; }
    /// Index of the source column in which a tile's first column begins in the first slice.
    const glm::ivec2& own() const { return own_; }
    /// Number of consecutive blocks whose slices are joined.
    std::size_t partCount() const { return ofFirst_.size(); }
    /// The source columns of column (0, 0), within one of those blocks.
    const ColumnRange& sourcesOfFirst(std::size_t part) const { return ofFirst_[part]; }

    TileSources sourcesOf(const JoinedTile& tile) const;
    /// Returns an upper bound of the joined blocks in a tile's columns of one u.
    std::size_t mostBlocks(const TileSources& sources, int u, int firstPlace, int lastPlace) const;
    /// Upper bound of the joined blocks in all tiles.
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

/// Joins the slices of a tile, from its first block to its last. Reads every block once per tile.
class JoinedTileReader {
  public:
    static constexpr std::size_t kColumns = std::size_t{kTileColumns.x} * kTileColumns.y;
    using BlockClasses = std::array<ClassIndex, 512>;

    /// @param classes,joiner,tiles  must outlive this object
    JoinedTileReader(const ClassReader& classes, const SliceJoiner& joiner,
                     const JoinedTiles& tiles);

    /// Starts a tile, before its first block in [firstPlace, lastPlace].
    void begin(const TileSources& sources, int firstPlace, int lastPlace);
    /// Moves to the next place along the slices with blocks. Returns false at the end.
    bool next();
    int place() const { return place_; }
    const glm::ivec2& columns() const { return columns_; }
    /// Whether a column, `[u][v]`, has a block at this place.
    bool has(std::size_t column) const { return has_[column]; }
    /// Returns the classes of this block, `[slice][u][v]`.
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
    glm::ivec2 columns_;  // number of joined columns
    TileSources rest_;    // blocks not read yet
    int lastPlace_ = 0;
    int place_ = 0;
    // A layer: the fewest blocks joined to whole slices, per source column. [slice][u][v]
    std::vector<std::bitset<TileSources::kCount>> isFilled_;  // [part][column]
    std::size_t sourceCount_;                                 // columns from here on have no blocks
    glm::ivec2 voxels_;                                       // size of a slice of the layer
    std::vector<ClassIndex> layer_;
    std::vector<BlockClasses> joined_;  // [column]
    std::bitset<kColumns> has_;
    LookCache cache_;
};

/// Whether pairs of slices of these classes can be joined for any step length: all classes have one
/// colour, so that their order does not matter, or there are few enough classes to number pairs.
bool canBePaired(const ClassTable& classes);

/// Parameters of a join.
struct JoinedRun {
    int slices;
    int within;               ///< as Subdivision::joinedWithin
    SeenThrough seenThrough;  ///< which slice of a pair is behind
    double steps;             ///< step length relative to that of the classes
};

/// Returns the premultiplied look of each class over a step; black if all classes have one colour.
std::vector<glm::dvec4> lightsOf(const ClassTable& classes);

/// Returns a joiner. It serves steps of any length if classes have one colour, or if two slices
/// that can be paired are joined without joining within slices.
SliceJoiner joinerOf(const ClassTable& classes, const JoinedRun& run);

/// Returns the classes of the joined voxels, after the joining.
ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         const JoinedRun& run);

}  // namespace deltasplat
