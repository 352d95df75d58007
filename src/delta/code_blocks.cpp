// SPDX-License-Identifier: Apache-2.0
#include "delta/code_blocks.h"

#include <algorithm>
#include <tuple>

#include "memory.h"

namespace deltasplat {
namespace {

// How far apart neighbours along x, y and z lie in a leaf's buffer.
constexpr glm::ivec3 kLeafStride{64, 8, 1};

// What the stage keeps for each block: itself, its place and its changes.
constexpr double kBytesPerBlock = sizeof(CodeBlock) + 16 + 128;

glm::ivec3 permuted(const openvdb::Coord& coord, const glm::ivec3& order) {
    return {coord[order[0]], coord[order[1]], coord[order[2]]};
}

}  // namespace

BlockReader::BlockReader(const CodeTree& codes, int sliceAxis, std::span<const Slot> slotMap)
    : slotMap_(slotMap), order_(sliceOrder(sliceAxis)) {
    // A tile may stand for any number of blocks: know how many before they are listed.
    double blocks = codes.tree.leafCount();
    const auto eachVisibleTile = [&](const auto& use) {
        auto tile = codes.tree.cbeginValueOn();
        tile.setMaxDepth(CodeTree::Tree::ValueOnCIter::LEAF_DEPTH - 1);
        for (; tile; ++tile) {
            if (slotOf(*tile) != kEmptySlot) use(tile.getBoundingBox(), slotOf(*tile));
        }
    };
    eachVisibleTile([&](const openvdb::CoordBBox& box, Slot) { blocks += box.volume() / 512.0; });
    requireMemory("list of voxel blocks", blocks * kBytesPerBlock);

    blocks_.reserve(std::size_t(blocks));
    for (auto leaf = codes.tree.cbeginLeaf(); leaf; ++leaf) {
        // Shifting keeps the floor of negative positions.
        blocks_.push_back({permuted(leaf->origin() >> 3, order_), &*leaf, kEmptySlot});
    }
    eachVisibleTile([&](const openvdb::CoordBBox& box, Slot slot) { addTile(box, slot); });
    std::sort(blocks_.begin(), blocks_.end(), [](const CodeBlock& a, const CodeBlock& b) {
        return std::tie(a.position.y, a.position.z, a.position.x) <
               std::tie(b.position.y, b.position.z, b.position.x);
    });
}

void BlockReader::addTile(const openvdb::CoordBBox& box, Slot slot) {
    const glm::ivec3 first = permuted(box.min() >> 3, order_);
    const glm::ivec3 last = permuted(box.max() >> 3, order_);
    for (int u = first.y; u <= last.y; ++u) {
        for (int v = first.z; v <= last.z; ++v) {
            for (int s = first.x; s <= last.x; ++s) blocks_.push_back({{s, u, v}, nullptr, slot});
        }
    }
}

void BlockReader::readBlock(const CodeBlock& block, BlockSlots& slots) const {
    readSlices(block, 0, slots.data());
}

void BlockReader::readLastSlice(const CodeBlock& block, std::span<Slot, 64> slots) const {
    readSlices(block, 7, slots.data());
}

void BlockReader::readSlices(const CodeBlock& block, int firstSlice, Slot* slots) const {
    if (!block.leaf) {
        std::fill_n(slots, 64 * (8 - firstSlice), block.tileSlot);
        return;
    }
    const Code* codes = block.leaf->buffer().data();
    const auto& active = block.leaf->getValueMask();
    const int strideS = kLeafStride[order_[0]];
    const int strideU = kLeafStride[order_[1]];
    const int strideV = kLeafStride[order_[2]];
    for (int s = firstSlice; s < 8; ++s) {
        for (int u = 0; u < 8; ++u) {
            for (int v = 0; v < 8; ++v) {
                const int n = s * strideS + u * strideU + v * strideV;
                *slots++ = active.isOn(n) ? slotOf(codes[n]) : kEmptySlot;
            }
        }
    }
}

}  // namespace deltasplat
