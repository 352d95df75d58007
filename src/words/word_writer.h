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

/// How many words several packers may store together.
class WordBudget {
  public:
    explicit WordBudget(double words) : most_(words), isSpent_(words <= 0) {}

    /// Takes some. Returns whether they, and all before them, may be stored.
    bool take(std::size_t words) {
        if (double(taken_ += words) > most_) isSpent_ = true;
        return !isSpent_;
    }
    /// Says that what was taken is so much of all that there will be: nothing may be stored where
    /// all is going to be too much.
    void foresee(double share) {
        if (double(taken_) > most_ * share) isSpent_ = true;
    }
    bool isSpent() const { return isSpent_; }

  private:
    double most_;
    std::atomic<std::size_t> taken_ = 0;
    std::atomic<bool> isSpent_;
};

/// A word before all words are in one place.
struct PendingWord {
    std::uint64_t visible;
    std::uint64_t changed;
    std::size_t classes;  ///< where they begin in the columns' storage, and looks in theirs
    int slice;
    glm::ivec2 block;
};

/// Where a word points to classes of which nothing is seen, or nobody needs them.
inline constexpr std::size_t kNoClasses = std::numeric_limits<std::size_t>::max();

/// Words of columns of blocks, those of a column in the order of its slices (and together, where
/// slices are walked from the last one on, or nothing is joined), and the
/// classes that they point to.
struct PackedColumns {
    std::vector<PendingWord> words;
    UnclearedVector<ClassIndex> storage;
    std::vector<OwnLook> looks;  ///< likewise, if voxels have their own
};

/// Returns what changes from a word's slice to the next, of all slices in which anything is seen or
/// changes.
std::uint64_t changedBehind(const std::vector<PendingWord>& words, std::size_t word);

/// Returns them with what words point to in the order of slices, as it is walked, and in no more
/// memory than they take; the words stay in their order.
PackedColumns sortClasses(const IndexBox& box, const PackedColumns& columns);

/// Puts the words of columns in the order of slices, those that slabs need, and takes over their
/// storage. Multi-threaded.
/// @param columns  ordered by u, then v
/// @param layout   of the slabs that `packed` has
void collectWords(std::vector<PackedColumns*> columns, const SlabLayout& layout, bool hasLooks,
                  PackedDeltas& packed);

/// Classes of a block's voxels, `[slice][u][v]`.
using BlockClasses = std::array<ClassIndex, 512>;

/// Words that a block may make: its slices, and one behind it that takes away what it showed.
inline constexpr std::size_t kMostWordsOfBlock = 9;
/// What a word takes until it has its place, and where voxels have looks of their own besides.
inline constexpr double kBytesPerWord =
    sizeof(DeltaWord) + sizeof(PendingWord) + 64 * sizeof(ClassIndex);
inline constexpr double kLookBytesPerWord = 64 * sizeof(OwnLook);

/// Which words are made: of all blocks, of which also is counted what is in their slices, or of
/// those of some slabs.
struct PackRange {
    SlabLayout layout;  ///< of slabs that there may be
    int firstBlock;
    int lastBlock;
    bool storesWords = true;
    /// Of the layout, which slabs are whole: words that these do not need are left out, but for
    /// those by which others are told from the slice behind. Empty: that is not known yet.
    std::span<const PlannedSlab> planned = {};
    /// Null: for any number of words. When it is spent, writers go on without.
    WordBudget* budget = nullptr;

    bool contains(int block) const { return block >= firstBlock && block <= lastBlock; }
};

/// Makes words of the classes of blocks, and counts what is in their slices. Blocks of a column
/// come in the order of slices. Not for several threads at once; several writers are.
class WordWriter {
  public:
    /// @param box      in (slice, u, v) order
    /// @param columns  how many there are at a time: what was before is kept for each
    WordWriter(const IndexBox& box, const PackOptions& options, const PackRange& range,
               std::size_t columns);

    const PackRange& range() const { return range_; }

    /// Begins with so many rows of words.
    /// @param room  memory for words that are not in order yet, which another writer may have used;
    ///              what is in it does not matter
    void begin(std::size_t rows, std::vector<PackedColumns>& room);
    /// Makes room for the most words that a row may get.
    void reserve(std::size_t row, std::size_t most);
    /// Forgets what was before, in all columns.
    void beginColumns();
    /// Adds the words of the first `slices` slices of a block.
    /// @param position  of the block, (slice, u, v) / 8
    /// @param looks     that voxels have of their own, or null
    /// @param column    number of the column that it goes on
    /// @param row       that it is packed in
    void add(const BlockClasses& classes, BlockLooks* looks, const glm::ivec3& position,
             std::size_t column, std::size_t row, int slices);
    /// Stops storing words where all writers have more than they may.
    void payForWords();
    /// Puts what words point to in order; then rows() has it.
    void finish(std::vector<PackedColumns>& room);

    /// What it made: of columns that are halved along u, the first halves and the second ones; of
    /// tiles, each row of columns.
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
    std::vector<std::array<ClassIndex, 64>> before_;  // [column]: of the slice before
    std::vector<PackedColumns> rows_;
    std::size_t paidWords_ = 0;  // of them
};

}  // namespace deltasplat
