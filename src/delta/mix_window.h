// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "delta/block_finder.h"

namespace deltasplat {

/// What values are mixed from: the slots (code + 1) of a block and of the voxels around it, empty
/// where none is active.
struct MixWindow {
    static constexpr int kSide = 10;
    static constexpr int kPlane = kSide * kSide;

    std::array<Slot, kSide * kPlane> slots{};  ///< `[slice][u][v]`, from one before the block

    /// @param place  of a voxel, -1..8 each, counted from the block's first
    Slot& at(const glm::ivec3& place) { return slots[indexOf(place)]; }
    Slot at(const glm::ivec3& place) const { return slots[indexOf(place)]; }
    static std::size_t indexOf(const glm::ivec3& place) {
        const int index = (place.x + 1) * kPlane + (place.y + 1) * kSide + place.z + 1;
        return std::size_t(index);
    }
    /// Whether all of it is one code.
    bool isUniform() const;
    /// Whether any voxel beside one of the block's, across edges and corners too, has a slot.
    bool hasAnyAround(const glm::ivec3& place) const;
};

/// Reads windows of a code tree. Not for several threads at once.
class MixWindowReader {
  public:
    /// @param alongSlicesOnly  leave what lies beside a block empty, but for what is before and
    ///                         behind it
    MixWindowReader(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly);

    void read(const CodeBlock& block, MixWindow& window) const;
    /// The same of whatever block is there.
    void read(const glm::ivec3& position, MixWindow& window) const;

  private:
    void readPart(const CodeBlock* block, const glm::ivec3& side, MixWindow& window) const;

    BlockFinder finder_;
    int sliceAxis_;
    int reach_;  // blocks beside
};

}  // namespace deltasplat
