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

/// The visible 8x8x8 blocks of a volume, numbered.
class LitBlocks {
  public:
    /// @param classes  must outlive the blocks, like `volume`
    LitBlocks(const Volume& volume, const ClassTable& classes);

    std::size_t size() const { return blocks_.size(); }
    /// Returns a block's number; -1 if none of its voxels is visible.
    /// @param position  (x, y, z) of the first voxel, divided by 8
    std::int64_t find(const glm::ivec3& position) const;

    /// World distances of voxels from a place, centre to centre.
    struct Reach {
        double nearest = 0;   ///< of the visible voxels
        double farthest = 0;  ///< upper bound for the visible voxels
    };
    /// @param placeIndex  (x, y, z)
    /// @return the distances; infinite and 0 if no voxel is visible
    Reach reachFrom(const glm::dvec3& placeIndex, const glm::dmat3& worldFromIndex) const;

    /// The blocks in the order in which light meets them along a slice axis.
    struct Along {
        /// Places [begin, end) of `order`: blocks in the same eight slices.
        struct Group {
            int firstSlice;
            std::size_t begin;
            std::size_t end;
        };
        struct Place {
            std::size_t number;
            glm::ivec2 first;  ///< (u, v) of the first voxel
        };
        int sliceAxis;
        std::vector<Place> order;   ///< by slice, u and v
        std::vector<Group> groups;  ///< by slice
        glm::ivec2 low{0};          ///< smallest (u, v) of any block's first voxel
        glm::ivec2 high{0};         ///< largest likewise
        /// `[block][slice][u][v]` of all blocks, even if `order` has only some.
        std::shared_ptr<const UnclearedArray<std::uint16_t>> classes;

        /// Adds a block. Its slice must not be below the slices of earlier blocks.
        void add(int firstSlice, const Place& place);
    };
    /// Multi-threaded.
    /// @throw Error(kFailed) if there is not enough memory
    Along along(int sliceAxis) const;

  private:
    struct Block {
        glm::ivec3 position;         // (x, y, z) of the first voxel, divided by 8
        const CodeTree::Leaf* leaf;  // null for a piece of a tile
        Slot tileClass;              // of all voxels if there is no leaf
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
