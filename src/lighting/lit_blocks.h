// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/uncleared.h"
#include "deltasplat/optics/class_table.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// The 8x8x8 blocks of a volume of which something can be seen, numbered.
class LitBlocks {
  public:
    /// @param classes  must outlive the blocks, as `volume`
    LitBlocks(const Volume& volume, const ClassTable& classes);

    std::size_t size() const { return blocks_.size(); }
    /// Returns a block's number; -1 if nothing of it can be seen.
    /// @param position  (x, y, z) of its first voxel, divided by 8
    std::int64_t find(const glm::ivec3& position) const;

    /// How far voxels are from a place, in the world, centre to centre.
    struct Reach {
        double nearest = 0;   ///< of those that can be seen
        double farthest = 0;  ///< at least that of any
    };
    /// Returns it; infinite and 0 if nothing can be seen.
    /// @param placeIndex  (x, y, z)
    Reach reachFrom(const glm::dvec3& placeIndex, const glm::dmat3& worldFromIndex) const;

    /// The blocks as light comes upon them along a slice axis.
    struct Along {
        /// Those of [begin, end) of `order` have their voxels in the same eight slices.
        struct Group {
            int firstSlice;
            std::size_t begin;
            std::size_t end;
        };
        /// A block.
        struct Place {
            std::size_t number;
            glm::ivec2 first;  ///< (u, v) of its first voxel
        };
        int sliceAxis;
        std::vector<Place> order;   ///< by slice, u and v
        std::vector<Group> groups;  ///< by slice
        glm::ivec2 low{0};          ///< (u, v): the smallest of any block's first voxel
        glm::ivec2 high{0};         ///< and the largest
        /// `[block][slice][u][v]`; of all blocks, whichever these are.
        std::shared_ptr<const UnclearedArray<std::uint16_t>> classes;

        /// Adds a block, whose slice is none before those that there are.
        void add(int firstSlice, const Place& place);
    };
    /// Multi-threaded.
    /// @throw Error(kFailed) if there is not enough memory
    Along along(int sliceAxis) const;

  private:
    struct Block {
        glm::ivec3 position;         // (x, y, z) of its first voxel, divided by 8
        const CodeTree::Leaf* leaf;  // null for a piece of a tile
        Slot tileClass;              // of all voxels, if there is no leaf
    };
    struct Hash {
        std::size_t operator()(const glm::ivec3& position) const;
    };
    void readClasses(int sliceAxis, std::uint16_t* classes) const;
    void readClasses(const Block& block, int sliceAxis, std::uint16_t* out) const;

    std::span<const Slot> classOfSlot_;
    std::vector<Block> blocks_;
    std::unordered_map<glm::ivec3, std::uint32_t, Hash> numbers_;  // by position
};

}  // namespace deltasplat
