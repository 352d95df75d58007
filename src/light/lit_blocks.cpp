// SPDX-License-Identifier: Apache-2.0
#include "light/lit_blocks.h"

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

std::size_t LitBlocks::Hash::operator()(const glm::ivec3& position) const {
    // Odd numbers that spread what lies side by side.
    const glm::u64vec3 parts{glm::u32vec3(position)};
    const std::uint64_t hash =
        parts.x * 0x9E3779B97F4A7C15 ^ parts.y * 0xC2B2AE3D27D4EB4F ^ parts.z * 0x165667B19E3779F9;
    return std::size_t(hash ^ hash >> 32);
}

}  // namespace deltasplat
