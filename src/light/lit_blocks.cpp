// SPDX-License-Identifier: Apache-2.0
#include "light/lit_blocks.h"

#include <algorithm>
#include <memory_resource>

#include "ingest/codes/leaf_slices.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {

LitBlocks::LitBlocks(const Volume& volume, const ClassTable& classes)
    : classOfSlot_(classes.classOfSlot) {
    // Along x, positions are (x, y, z).
    const BlockReader reader(*volume.codes, nullptr, 0, classOfSlot_);
    blocks_.reserve(reader.blocks().size());
    numbers_.reserve(reader.blocks().size());
    for (const CodeBlock& block : reader.blocks()) {
        numbers_.emplace(block.position, std::uint32_t(blocks_.size()));
        blocks_.push_back({block.position, block.leaf, block.tileSlot});
    }
}

std::int64_t LitBlocks::find(const glm::ivec3& position) const {
    const auto found = numbers_.find(position);
    return found == numbers_.end() ? -1 : std::int64_t(found->second);
}

UnclearedArray<std::uint16_t> LitBlocks::classesAlong(int sliceAxis) const {
    const std::size_t voxels = 512 * blocks_.size();
    requireMemory("classes that light meets", double(sizeof(std::uint16_t)) * double(voxels));
    UnclearedArray<std::uint16_t> classes(voxels, *std::pmr::get_default_resource());
    parallelForChunks(blocks_.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t number = begin; number < end; ++number) {
            const Block& block = blocks_[number];
            std::uint16_t* out = &classes[512 * number];
            if (block.leaf) {
                readLeafSlices(
                    *block.leaf, sliceAxis,
                    [&](Code code) { return classOfSlot_[std::size_t(code) + 1]; }, out);
            } else {
                std::fill_n(out, 512, std::uint16_t(block.tileClass));
            }
        }
    });
    return classes;
}

std::size_t LitBlocks::Hash::operator()(const glm::ivec3& position) const {
    // Odd numbers that spread what lies side by side.
    const glm::u64vec3 parts{glm::u32vec3(position)};
    const std::uint64_t hash =
        parts.x * 0x9E3779B97F4A7C15 ^ parts.y * 0xC2B2AE3D27D4EB4F ^ parts.z * 0x165667B19E3779F9;
    return std::size_t(hash ^ hash >> 32);
}

}  // namespace deltasplat
