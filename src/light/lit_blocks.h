// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "delta/code_blocks.h"
#include "deltasplat/optics/class_table.h"
#include "uncleared_array.h"

namespace deltasplat {

/// The 8x8x8 blocks of a volume of which something can be seen, numbered.
class LitBlocks {
  public:
    /// @param classes  must outlive the blocks, as `volume`
    LitBlocks(const Volume& volume, const ClassTable& classes);

    struct Block {
        glm::ivec3 position;         ///< (x, y, z) of its first voxel, divided by 8
        const CodeTree::Leaf* leaf;  ///< null for a piece of a tile
        Slot tileClass;              ///< of all voxels, if there is no leaf
    };
    const std::vector<Block>& all() const { return blocks_; }
    /// Returns a block's number; -1 if nothing of it can be seen.
    std::int64_t find(const glm::ivec3& position) const;
    /// Returns the classes of the blocks' voxels, `[block][slice][u][v]`. Multi-threaded.
    UnclearedArray<std::uint16_t> classesAlong(int sliceAxis) const;

  private:
    struct Hash {
        std::size_t operator()(const glm::ivec3& position) const;
    };

    std::span<const Slot> classOfSlot_;
    std::vector<Block> blocks_;
    std::unordered_map<glm::ivec3, std::uint32_t, Hash> numbers_;  // by position
};

}  // namespace deltasplat
