// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "deltasplat/delta/delta_grid.h"

namespace deltasplat {

/// Limits of slabs, in blocks of 8 slices.
struct SlabLayout {
    int firstBlock = 0;  ///< of the first slab
    int blocksPerSlab = 1;
    int lastBlock = 0;  ///< last block with slices
    int lastSlice = 0;

    int slabOf(int block) const { return (block - firstBlock) / blocksPerSlab; }
    bool startsSlab(int block) const { return (block - firstBlock) % blocksPerSlab == 0; }
    /// Whether a slice is the first one of any slab but the first.
    bool startsLaterSlab(int slice) const {
        return slice % 8 == 0 && slice > 8 * firstBlock && startsSlab(slice / 8);
    }
    bool endsSlab(int slice) const { return slice >= lastSlice || startsLaterSlab(slice + 1); }
    int count() const { return slabOf(lastBlock) + 1; }
    int blocks() const { return lastBlock - firstBlock + 1; }
    /// Number of existing slices. After the last one no voxels need to be taken away.
    int slicesOf(int block) const { return std::min(7, lastSlice - 8 * block) + 1; }
};

/// @param box  not empty, in (slice, u, v) order
inline SlabLayout layoutOf(const IndexBox& box, int keyInterval) {
    return {box.min.x >> 3, keyInterval / 8, box.max.x >> 3, box.max.x};
}

inline SliceCounts& operator+=(SliceCounts& sum, const SliceCounts& counts) {
    sum.visible += counts.visible;
    sum.deltas += counts.deltas;
    return sum;
}

inline SlabLayout oneSlab(const IndexBox& box) {
    SlabLayout layout = layoutOf(box, 8);
    layout.blocksPerSlab = layout.blocks();
    return layout;
}

inline void placeSlab(const IndexBox& box, const SlabLayout& layout, int i, Slab& slab) {
    const int begin = 8 * (layout.firstBlock + i * layout.blocksPerSlab);
    slab.firstSlice = std::max(begin, box.min.x);
    slab.sliceCount = std::min(begin + 8 * layout.blocksPerSlab, box.max.x + 1) - slab.firstSlice;
}

template <typename AnySlab>
std::uint64_t sumOf(const std::vector<AnySlab>& slabs, std::uint64_t Slab::*count) {
    std::uint64_t sum = 0;
    for (const AnySlab& slab : slabs) sum += slab.*count;
    return sum;
}

inline IndexBox permutedBox(const IndexBox& box, int sliceAxis) {
    return {toSliceOrder(box.min, sliceAxis), toSliceOrder(box.max, sliceAxis)};
}

}  // namespace deltasplat
