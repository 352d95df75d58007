// SPDX-License-Identifier: Apache-2.0
// OpenVDB's 8x8x8 blocks in the order of a slice axis.
#pragma once

#include <openvdb/math/Coord.h>

#include <bit>
#include <cstdint>

#include "deltasplat/ingest/slot.h"
#include "volume/code_tree.h"

namespace deltasplat {

/// Distances of neighbours along x, y and z in a leaf's buffer.
inline constexpr glm::ivec3 kLeafStride{64, 8, 1};

/// Returns the place of a block's first voxel.
/// @param position  of the block in (slice, u, v) order, divided by 8
inline openvdb::Coord blockOrigin(const glm::ivec3& position, int sliceAxis) {
    const glm::ivec3 xyz = 8 * fromSliceOrder(position, sliceAxis);
    return {xyz.x, xyz.y, xyz.z};
}

/// Calls use(place, n) per voxel from `first` to `last`, slice by slice: (slice, u, v), 0..7 each,
/// and the index in a leaf's buffer.
template <typename Use>
void forLeafVoxels(int sliceAxis, const glm::ivec3& first, const glm::ivec3& last, const Use& use) {
    const glm::ivec3 stride = toSliceOrder(kLeafStride, sliceAxis);
    for (int s = first.x; s <= last.x; ++s) {
        for (int u = first.y; u <= last.y; ++u) {
            for (int v = first.z; v <= last.z; ++v)
                use(glm::ivec3(s, u, v), s * stride.x + u * stride.y + v * stride.z);
        }
    }
}

/// Calls use(place, n) for all voxels of a block, slice by slice.
template <typename Use>
void forLeafVoxels(int sliceAxis, const Use& use) {
    forLeafVoxels(sliceAxis, glm::ivec3(0), glm::ivec3(7), use);
}

/// Writes the empty slot at a leaf's inactive voxels. kStep: as for readLeafWithSteps.
template <int kStepX, int kStepY, int kStepZ, typename Out>
void clearInactive(const CodeTree::Leaf& leaf, Out* out) {
    if (leaf.isDense()) return;
    for (int x = 0; x < 8; ++x) {
        std::uint64_t inactive = ~leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(x));
        for (; inactive != 0; inactive &= inactive - 1) {
            const int n = std::countr_zero(inactive);
            out[x * kStepX + (n >> 3) * kStepY + (n & 7) * kStepZ] = kEmptySlot;
        }
    }
}

/// Reads a leaf as readLeafSlices does. kStep: distances of neighbours along x, y and z in `out`.
/// Reading is several times as fast if the compiler knows these constants.
template <int kStepX, int kStepY, int kStepZ, typename SlotOf, typename Out>
void readLeafWithSteps(const CodeTree::Leaf& leaf, const SlotOf& slotOf, Out* out) {
    const Code* codes = leaf.buffer().data();
    for (int x = 0; x < 8; ++x) {
        for (int y = 0; y < 8; ++y) {
            for (int z = 0; z < 8; ++z) {
                out[x * kStepX + y * kStepY + z * kStepZ] = Out(slotOf(*codes++));
            }
        }
    }
    clearInactive<kStepX, kStepY, kStepZ>(leaf, out);
}

template <typename Use>
void withLeafSteps(int sliceAxis, const Use& use) {
    if (sliceAxis == 0) return use.template operator()<64, 8, 1>();
    if (sliceAxis == 1) return use.template operator()<1, 64, 8>();
    use.template operator()<8, 1, 64>();
}

/// Reads a leaf of codes: slotOf(code) for active voxels, empty for others.
/// @param out  [slice][u][v]
template <typename SlotOf, typename Out>
void readLeafSlices(const CodeTree::Leaf& leaf, int sliceAxis, const SlotOf& slotOf, Out* out) {
    withLeafSteps(sliceAxis, [&]<int kStepX, int kStepY, int kStepZ>() {
        readLeafWithSteps<kStepX, kStepY, kStepZ>(leaf, slotOf, out);
    });
}

/// Writes the empty slot at a leaf's inactive voxels.
/// @param out  [slice][u][v]
template <typename Out>
void clearInactiveSlices(const CodeTree::Leaf& leaf, int sliceAxis, Out* out) {
    withLeafSteps(sliceAxis, [&]<int kStepX, int kStepY, int kStepZ>() {
        clearInactive<kStepX, kStepY, kStepZ>(leaf, out);
    });
}

template <typename Leaf>
constexpr double leafBytes() {
    return sizeof(Leaf) + Leaf::NUM_VALUES * sizeof(typename Leaf::ValueType);
}

}  // namespace deltasplat
