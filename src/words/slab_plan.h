// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/delta/delta_grid.h"
#include "volume/slab_layout.h"

namespace deltasplat {

/// How the slices of slabs are splatted.
enum class Encoding {
    kChanges,  ///< one key slice per slab, then deltas (method `delta`)
    kWhole,    ///< every slice anew (`sparse` and `traditional`)
    /// Per slab kWhole, unless kChanges splats something and saves a tenth of the words.
    kFewerWords,
    /// As kFewerWords; saving a seventh of the voxels suffices, too.
    kFewerWordsOrVoxels,
    /// As kFewerWords; saving a quarter of the writing (MaskCounts::writes) suffices, too.
    kFewerWordsOrWrites,
    /// As kFewerWords; if few voxels per word change, kWhole only if it saves 3/8 of the stamps.
    kFewerWordsOrStamps
};

enum class SlabLength {
    kShortest,  ///< at most 8 slabs
    kByCounts   ///< at most 8 slabs, fewer depending on their content
};

/// A slab as a picture is rendered from it. Deltas are counted in increasing slice order with the
/// first slice as key slice, whichever way a picture walks.
struct PlannedSlab : Slab {
    bool whole = false;  ///< every slice is splatted anew

    std::uint64_t words = 0;      ///< mask words with deltas
    std::uint64_t seenWords = 0;  ///< mask words with visible voxels

    /// Whether a word of a slice has anything to splat.
    /// @param isKey  the slice is the first of its slab in walking order
    bool needs(bool isKey, std::uint64_t visible, std::uint64_t changed) const {
        return (whole || isKey ? visible : changed) != 0;
    }
    std::uint64_t stamps() const { return whole ? visible : deltas; }
    /// Number of words with stamps.
    std::uint64_t stampedWords() const { return whole ? seenWords : words; }
};

struct SlabPlan {
    SlabLayout layout;
    std::vector<PlannedSlab> slabs;  ///< in increasing order
};

/// Counts the voxels of a volume's slices, and cuts slices into at most 8 slabs. If key slices
/// would add more than 3 % to the deltas, pairs of slabs are joined until they add less, unless
/// SlabLength::kShortest is asked for; slabs of more than 32 slices never become fewer than 4. The
/// result depends on the volume and its visible classes, not on the encoding, so that all methods
/// merge the same layers.
class SlabPlanner {
  public:
    /// @param box  in (slice, u, v) order, not empty
    explicit SlabPlanner(const IndexBox& box);

    /// Layout of the shortest slabs.
    const SlabLayout& shortest() const { return shortest_; }
    /// Adds slices of a block: mask words of visible voxels, and of changes from the slice before.
    /// @param slice  the first of one or more slices
    void add(int slice, std::span<const std::uint64_t> visible,
             std::span<const std::uint64_t> changed);
    /// Adds the counts of another planner of the same box.
    void add(const SlabPlanner& other);
    SlabPlan plan(Encoding encoding, SlabLength length = SlabLength::kByCounts) const;

  private:
    // Contents of slices: voxels, non-empty mask words, and time to write.
    struct Counts {
        SliceCounts voxels;
        SliceCounts words;
        SliceCounts writes;
        void operator+=(const Counts& other) {
            voxels += other.voxels;
            words += other.words;
            writes += other.writes;
        }
        // Makes a counted slice a key slice: all of its visible voxels become deltas.
        void addKeySlice(const Counts& slice) {
            voxels.deltas += slice.voxels.visible - slice.voxels.deltas;
            words.deltas += slice.words.visible - slice.words.deltas;
            writes.deltas += slice.writes.visible - slice.writes.deltas;
        }
    };
    // Contents of one of the shortest slabs, as if no key slice began it.
    struct SlabCounts {
        Counts all;
        Counts firstSlice;  // share of `all` in the first slice; 0 for the first slab
    };

    int chooseLength() const;
    double keyShare(std::size_t length) const;

    IndexBox box_;
    SlabLayout shortest_;
    std::vector<SlabCounts> counts_;
};

}  // namespace deltasplat
