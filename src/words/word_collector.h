// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <vector>

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

}  // namespace deltasplat
