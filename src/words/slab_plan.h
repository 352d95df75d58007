// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "volume/slab_layout.h"

namespace deltasplat {

/// How the slices of a picture's slabs are splatted.
enum class Encoding {
    kChanges,  ///< as one key slice a slab, then deltas (method `delta`)
    kWhole,    ///< every slice anew (`sparse` and `traditional`)
    /// For each slab kWhole unless kChanges has something to splat in fewer words by a tenth.
    kFewerWords,
    /// The same, or of fewer voxels by a seventh.
    kFewerWordsOrVoxels,
    /// The same, or in less writing by a quarter (MaskCounts::writes).
    kFewerWordsOrWrites,
    /// The same; but where few voxels of words change, kWhole only if it takes fewer stamps by
    /// three eighths.
    kFewerWordsOrStamps
};

/// How long slabs are.
enum class SlabLength {
    kShortest,  ///< there are 8 at most
    kByCounts   ///< or fewer, by what is in them
};

/// A slab as a picture is rendered from it. Deltas are counted from each slice to the next, with
/// the first one as the key slice, whichever way a picture walks them.
struct PlannedSlab : Slab {
    bool whole = false;  ///< every slice is splatted anew

    std::uint64_t words = 0;      ///< mask words with deltas
    std::uint64_t seenWords = 0;  ///< mask words with visible voxels

    /// Whether a word of a slice of it has anything to splat.
    /// @param isKey  whether that slice is told from none: in the order in which slices are walked,
    ///               the first of a slab
    bool needs(bool isKey, std::uint64_t visible, std::uint64_t changed) const {
        return (whole || isKey ? visible : changed) != 0;
    }
    std::uint64_t stamps() const { return whole ? visible : deltas; }
    /// Words that have any.
    std::uint64_t stampedWords() const { return whole ? seenWords : words; }
};

/// The slabs that a picture is rendered from.
struct SlabPlan {
    SlabLayout layout;
    std::vector<PlannedSlab> slabs;  ///< in increasing order
};

/// Counts what is in the slices of a volume, and cuts it into slabs by it. There are 8 at most.
/// Where key slices would add more than 3 % to the deltas, they are joined two and two as long as
/// that is so, unless they are to be as short as they may be; but slabs of more than 32 slices
/// never become fewer than 4. A function of the volume and the classes it shows, whatever the
/// encoding, so that all methods merge the same layers.
class SlabPlanner {
  public:
    /// @param box  in (slice, u, v) order, not empty
    explicit SlabPlanner(const IndexBox& box);

    /// Of the shortest slabs that there may be.
    const SlabLayout& shortest() const { return shortest_; }
    /// Adds voxels of slices of a block of 8, one or more: of each, mask words of visible ones, and
    /// of those that differ from the slice before.
    /// @param slice  the first of them
    void add(int slice, std::span<const std::uint64_t> visible,
             std::span<const std::uint64_t> changed);
    /// Adds what another planner of the same box has counted.
    void add(const SlabPlanner& other);
    SlabPlan plan(Encoding encoding, SlabLength length = SlabLength::kByCounts) const;

  private:
    // What is in slices: voxels, mask words with any, and what writing them takes.
    struct Counts {
        SliceCounts voxels;
        SliceCounts words;
        SliceCounts writes;
        void operator+=(const Counts& other) {
            voxels += other.voxels;
            words += other.words;
            writes += other.writes;
        }
        // Makes deltas of all that is visible in a slice that is counted: it becomes a key slice.
        void addKeySlice(const Counts& slice) {
            voxels.deltas += slice.voxels.visible - slice.voxels.deltas;
            words.deltas += slice.words.visible - slice.words.deltas;
            writes.deltas += slice.writes.visible - slice.writes.deltas;
        }
    };
    // What is in one of the shortest slabs, as if no key slice began it.
    struct SlabCounts {
        Counts all;
        Counts firstSlice;  // of which in its first slice; 0 for the first slab
    };

    int chooseLength() const;
    double keyShare(std::size_t length) const;

    IndexBox box_;
    SlabLayout shortest_;
    std::vector<SlabCounts> counts_;
};

}  // namespace deltasplat
