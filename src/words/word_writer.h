// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "words/block_looks.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// A limit of the words that several packers store together.
class WordBudget {
  public:
    explicit WordBudget(double words) : most_(words), isSpent_(words <= 0) {}

    /// Takes some words. Returns whether these and all earlier words may be stored.
    bool take(std::size_t words) {
        if (double(taken_ += words) > most_) isSpent_ = true;
        return !isSpent_;
    }
    /// Announces the share of words so far. Spends the budget if the total would exceed it.
    void foresee(double share) {
        if (double(taken_) > most_ * share) isSpent_ = true;
    }
    bool isSpent() const { return isSpent_; }

  private:
    double most_;
    std::atomic<std::size_t> taken_ = 0;
    std::atomic<bool> isSpent_;
};

/// A word before all words are collected.
struct PendingWord {
    std::uint64_t visible;
    std::uint64_t changed;
    std::size_t classes;  ///< index in the columns' storage; looks have the same index
    int slice;
    glm::ivec2 block;
};

/// Index of a word without visible voxels, or whose classes nobody needs.
inline constexpr std::size_t kNoClasses = std::numeric_limits<std::size_t>::max();

/// Words of columns of blocks and their classes. The words of a column are in slice order (and
/// adjacent if slices are walked backwards or nothing is joined).
struct PackedColumns {
    std::vector<PendingWord> words;
    UnclearedVector<ClassIndex> storage;
    std::vector<OwnLook> looks;  ///< like `storage`, if voxels have their own looks
};

/// Returns the changes to the next slice. `words` has all slices with visible or changed voxels.
std::uint64_t changedBehind(const std::vector<PendingWord>& words, std::size_t word);

/// Returns columns with classes and looks in slice order, without spare memory, and the same words.
PackedColumns sortClasses(const IndexBox& box, const PackedColumns& columns);

/// Moves the words that slabs need into slice order, and takes over their storage. Multi-threaded.
/// @param columns  ordered by u, then v
/// @param layout   of the slabs of `packed`
void collectWords(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed);

using BlockClasses = std::array<ClassIndex, 512>;

/// Most words of a block: its slices, and one behind them that removes its voxels.
inline constexpr std::size_t kMostWordsOfBlock = 9;
/// Memory of a word until it is collected, and of its own looks.
inline constexpr double kBytesPerWord =
    sizeof(DeltaWord) + sizeof(PendingWord) + 64 * sizeof(ClassIndex);
inline constexpr double kLookBytesPerWord = 64 * sizeof(OwnLook);

/// Which words to make: of all blocks, with counts of their slices, or of the blocks of some slabs.
struct PackRange {
    SlabLayout layout;  ///< of possible slabs
    int firstBlock;
    int lastBlock;
    bool storesWords = true;
    /// Slabs of the layout, known to be whole or not. Words that they do not need are left out,
    /// except words by which changes towards the slice behind are told. Empty: not planned yet.
    std::span<const PlannedSlab> planned = {};
    /// Null: no limit. When the budget is spent, writers continue without storing.
    WordBudget* budget = nullptr;

    bool contains(int block) const { return block >= firstBlock && block <= lastBlock; }
};

/// Makes words from the classes of blocks, and counts the contents of slices. The blocks of a
/// column come in slice order. One thread per writer.
class WordWriter {
  public:
    /// @param box      in (slice, u, v) order
    /// @param columns  number of columns in progress; each keeps its slice before
    WordWriter(const IndexBox& box, const PackOptions& options, const PackRange& range,
               std::size_t columns);

    const PackRange& range() const { return range_; }

    /// Starts with some rows of words.
    /// @param room  reusable memory for unsorted words; its contents are ignored
    void begin(std::size_t rows, std::vector<PackedColumns>& room);
    void reserve(std::size_t row, std::size_t most);
    void beginColumns();
    /// Adds the words of the first `slices` slices of a block.
    /// @param position  of the block, (slice, u, v) / 8
    /// @param looks     own looks of voxels, or null
    /// @param column    column in progress
    /// @param row       row that gets the words
    void add(const BlockClasses& classes, BlockLooks* looks, const glm::ivec3& position,
             std::size_t column, std::size_t row, int slices);
    /// Stops storing words if the budget of all writers is spent.
    void payForWords();
    /// Sorts classes and looks; rows() then has the result.
    void finish(std::vector<PackedColumns>& room);

    /// The result: of halved columns, first and second halves; of tiles, each row of columns.
    std::vector<PackedColumns>& rows() { return rows_; }
    const SlabPlanner& planner() const { return planner_; }

  private:
    bool isNeeded(int slice, std::uint64_t visible, std::uint64_t changed) const;
    bool mayBeWhole(int slice) const;
    void dropUnneeded(std::vector<PendingWord>& words) const;

    IndexBox box_;
    Encoding encoding_;
    bool descending_;
    bool hasLooks_;
    PackRange range_;
    SlabPlanner planner_;
    std::vector<std::array<ClassIndex, 64>> before_;  // [column]: classes of the slice before
    std::vector<PackedColumns> rows_;
    std::size_t paidWords_ = 0;  // number of words taken from the budget
};

}  // namespace deltasplat
