// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// Where slabs begin and end, in blocks of 8 slices.
struct SlabLayout {
    int firstBlock = 0;  ///< of the first slab
    int blocksPerSlab = 1;
    int lastBlock = 0;  ///< that has slices
    int lastSlice = 0;

    int slabOf(int block) const { return (block - firstBlock) / blocksPerSlab; }
    bool startsSlab(int block) const { return (block - firstBlock) % blocksPerSlab == 0; }
    /// Whether a slice is the first of a slab behind another.
    bool startsLaterSlab(int slice) const {
        return slice % 8 == 0 && slice > 8 * firstBlock && startsSlab(slice / 8);
    }
    /// Whether a slice is the last of a slab.
    bool endsSlab(int slice) const { return slice >= lastSlice || startsLaterSlab(slice + 1); }
    int count() const { return slabOf(lastBlock) + 1; }
    int blocks() const { return lastBlock - firstBlock + 1; }
    /// Slices of a block that exist: behind the last one nothing needs to be taken away.
    int slicesOf(int block) const { return std::min(7, lastSlice - 8 * block) + 1; }
};

/// Returns the layout of a box in (slice, u, v) order that is not empty.
inline SlabLayout layoutOf(const IndexBox& box, int keyInterval) {
    return {box.min.x >> 3, keyInterval / 8, box.max.x >> 3, box.max.x};
}

inline SliceCounts& operator+=(SliceCounts& sum, const SliceCounts& counts) {
    sum.visible += counts.visible;
    sum.deltas += counts.deltas;
    return sum;
}

/// Returns the layout of one slab of all slices.
inline SlabLayout oneSlab(const IndexBox& box) {
    SlabLayout layout = layoutOf(box, 8);
    layout.blocksPerSlab = layout.blocks();
    return layout;
}

/// Sets the slices of slab `i`.
inline void placeSlab(const IndexBox& box, const SlabLayout& layout, int i, Slab& slab) {
    const int begin = 8 * (layout.firstBlock + i * layout.blocksPerSlab);
    slab.firstSlice = std::max(begin, box.min.x);
    slab.sliceCount = std::min(begin + 8 * layout.blocksPerSlab, box.max.x + 1) - slab.firstSlice;
}

/// Returns the sum of one of the counts of all slabs.
template <typename AnySlab>
std::uint64_t sumOf(const std::vector<AnySlab>& slabs, std::uint64_t Slab::*count) {
    std::uint64_t sum = 0;
    for (const AnySlab& slab : slabs) sum += slab.*count;
    return sum;
}

/// Returns a volume's box in (slice, u, v) order.
inline IndexBox permutedBox(const IndexBox& box, int sliceAxis) {
    return {toSliceOrder(box.min, sliceAxis), toSliceOrder(box.max, sliceAxis)};
}

}  // namespace deltasplat
