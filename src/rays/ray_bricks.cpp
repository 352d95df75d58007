// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_bricks.h"

#include <algorithm>
#include <bit>
#include <memory_resource>
#include <unordered_map>

#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

constexpr std::size_t kVoxels = 512;

void emptyInactive(const CodeTree::Leaf& leaf, float empty, float* values) {
    if (leaf.isDense()) return;
    const auto& mask = leaf.getValueMask();
    for (int x = 0; x < 8; ++x) {
        std::uint64_t off = ~mask.getWord<std::uint64_t>(openvdb::Index(x));
        for (; off != 0; off &= off - 1) values[64 * x + std::countr_zero(off)] = empty;
    }
}

void fillBrick(const RayVolume& volume, const CodeBlock& block, float empty, float* values) {
    const BlockPlace place{values, 64, 8};
    if (volume.sourceValues) {
        volume.sourceValues(block, place);
    } else if (block.leaf) {
        readBlockValues(block.leaf->buffer().data(), volume.sliceAxis, volume.values, place);
    } else {
        std::fill_n(values, kVoxels, volume.valueOf(Code(block.tileSlot - 1)));
    }
    if (block.leaf) emptyInactive(*block.leaf, empty, values);
}

// Numbers bricks from 1 on; uniform ones of one value share theirs. Returns the first block of each
// number.
std::vector<const CodeBlock*> numberBlocks(const RayVolume& volume,
                                           std::vector<std::uint32_t>& numberOf) {
    std::vector<const CodeBlock*> firsts{nullptr};
    std::unordered_map<Slot, std::uint32_t> tiles;
    for (const CodeBlock& block : volume.blocks) {
        const bool shared = !block.leaf && !volume.sourceValues;
        const auto next = std::uint32_t(firsts.size());
        const std::uint32_t number =
            shared ? tiles.try_emplace(block.tileSlot, next).first->second : next;
        if (number == next) firsts.push_back(&block);
        numberOf.push_back(number);
    }
    return firsts;
}

}  // namespace

RayBricks::RayBricks(const RayVolume& volume, float empty) {
    const auto blockOf = [](const glm::ivec3& voxel) {
        return glm::ivec3(voxel.x >> 3, voxel.y >> 3, voxel.z >> 3);
    };
    const glm::ivec3 first = blockOf(volume.box.min) - 1;
    const glm::ivec3 count = blockOf(volume.box.max) + 2 - first;
    origin_ = 8 * first;
    strides_ = {std::ptrdiff_t{count.y} * count.z, count.z, 1};
    const double places = double(count.x) * count.y * count.z;
    requireMemory("bricks of the volume", sizeof(std::uint32_t) * places);
    numbers_.assign(std::size_t(places), 0);

    std::vector<std::uint32_t> numberOf;
    const std::vector<const CodeBlock*> firsts = numberBlocks(volume, numberOf);
    for (std::size_t i = 0; i < numberOf.size(); ++i) {
        const glm::ivec3 at = volume.blocks[i].position - first;
        numbers_[std::size_t(at.x * strides_.x + at.y * strides_.y + at.z)] = numberOf[i];
    }
    requireMemory("bricks of the volume", double(sizeof(float) * kVoxels) * double(firsts.size()));
    values_ = UnclearedArray<float>(kVoxels * firsts.size(), *std::pmr::new_delete_resource());
    std::fill_n(&values_[0], kVoxels, empty);
    parallelForChunks(firsts.size() - 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin + 1; i <= end; ++i)
            fillBrick(volume, *firsts[i], empty, &values_[kVoxels * i]);
    });
}

}  // namespace deltasplat
