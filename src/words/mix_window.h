// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <optional>

#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// Finds single blocks of a code tree by position. Not thread-safe.
class BlockFinder {
  public:
    BlockFinder(const CodeTree& codes, int sliceAxis);

    /// Returns a block with active voxels. Tile slots are code + 1. Only SlotBlocks give a range.
    std::optional<CodeBlock> find(const glm::ivec3& position) const;

  private:
    const SlotBlocks* blocks_;  // null: search the tree
    std::optional<openvdb::tree::ValueAccessor<const CodeTree::Tree>> accessor_;
    int sliceAxis_;
};

/// Slots (code + 1) of a block and its rim, from which values are mixed. Inactive voxels are empty.
struct MixWindow {
    static constexpr int kSide = 10;
    static constexpr int kPlane = kSide * kSide;

    std::array<Slot, kSide * kPlane> slots{};  ///< `[slice][u][v]`, from one voxel before the block

    /// @param place  (slice, u, v), -1..8 each, relative to the block's first voxel
    Slot& at(const glm::ivec3& place) { return slots[indexOf(place)]; }
    Slot at(const glm::ivec3& place) const { return slots[indexOf(place)]; }
    static std::size_t indexOf(const glm::ivec3& place) {
        const int index = (place.x + 1) * kPlane + (place.y + 1) * kSide + place.z + 1;
        return std::size_t(index);
    }
    /// Whether all voxels have the same code.
    bool isUniform() const;
    /// Whether any of a voxel's 26 neighbours has a slot.
    bool hasAnyAround(const glm::ivec3& place) const;
};

/// Interpolates from `here` to `other`; `here` if `other` is NaN. No branch, so that it vectorizes.
template <typename T>
inline T mixed(T here, T other, T share) {
    // Halves cannot overflow.
    const T difference = T(0.5) * other - T(0.5) * here;
    const T step = difference * (T(2) * share);
    return here + (difference == difference ? step : T(0));
}

/// Divides a row of voxels into thin ones, using the neighbours on both sides.
template <typename T>
inline void mixHalves(const T* row, T* thin) {
    for (int v = 0; v < 8; ++v) {
        thin[2 * v] = mixed(row[v + 1], row[v], T(0.25));
        thin[2 * v + 1] = mixed(row[v + 1], row[v + 2], T(0.25));
    }
}

/// Mixes the values of a block's thin voxels and calls use(part, place, values) per row of 8 along
/// v. `part` indexes [along u][along slices][along v]; `place` is 64 slice + 8 u.
/// @param values  as MixWindow::slots, NaN without a value
template <typename T, typename Use>
void mixRows(const std::array<T, MixWindow::kSide * MixWindow::kPlane>& values,
             const Subdivision& parts, const Use& use) {
    constexpr int kSide = MixWindow::kSide;
    constexpr int kPlane = MixWindow::kPlane;
    std::array<T, kPlane> plane;
    std::array<T, kSide> row;
    std::array<T, 16> thin;
    for (int s = 0; s < 8 * parts.slices; ++s) {
        // Distance from the voxel's centre, in halves of a thin slice.
        const int offset = 2 * (s % parts.slices) + 1 - parts.slices;
        const T* here = values.data() + (1 + s / parts.slices) * kPlane;
        const T* other = offset < 0 ? here - kPlane : here + kPlane;
        const T share = T(std::abs(offset)) / T(2 * parts.slices);
        for (int n = 0; n < kPlane; ++n) plane[n] = mixed(here[n], other[n], share);
        for (int u = 0; u < 8 * parts.within; ++u) {
            const int part = (u / 8 * parts.slices + s / 8) * parts.within;
            const int place = 64 * (s % 8) + 8 * (u % 8);
            const T* own = plane.data() + (1 + u / parts.within) * kSide;
            if (parts.within == 1) {
                use(part, place, own + 1);
                continue;
            }
            const T* beside = u % 2 == 0 ? own - kSide : own + kSide;
            for (int v = 0; v < kSide; ++v) row[v] = mixed(own[v], beside[v], T(0.25));
            mixHalves(row.data(), thin.data());
            use(part, place, thin.data());
            use(part + 1, place, thin.data() + 8);
        }
    }
}

/// Reads windows of a code tree. Not thread-safe.
class MixWindowReader {
  public:
    /// @param alongSlicesOnly  read only neighbours along the slices; leave the others empty
    MixWindowReader(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly);

    void read(const CodeBlock& block, MixWindow& window) const;
    void read(const glm::ivec3& position, MixWindow& window) const;

  private:
    void readPart(const CodeBlock* block, const glm::ivec3& side, MixWindow& window) const;

    BlockFinder finder_;
    int sliceAxis_;
    int reach_;  // number of neighbour blocks along u and v
};

}  // namespace deltasplat
