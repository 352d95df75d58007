// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <optional>

#include "deltasplat/view/factorization.h"
#include "volume/code_blocks.h"

namespace deltasplat {

/// Finds single blocks of a code tree by their place. Not for several threads at once.
class BlockFinder {
  public:
    BlockFinder(const CodeTree& codes, int sliceAxis);

    /// Returns a block, slots of tiles being code + 1, if any of it is active. Its range of codes
    /// is left out, unless it is one of SlotBlocks.
    std::optional<CodeBlock> find(const glm::ivec3& position) const;

  private:
    const SlotBlocks* blocks_;  // null: the tree is searched
    std::optional<openvdb::tree::ValueAccessor<const CodeTree::Tree>> accessor_;
    int sliceAxis_;
};

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

/// Returns what lies between two values, or the first where there is no other; NaN where there is
/// none. Without a branch, so that several are mixed at once.
template <typename T>
inline T mixed(T here, T other, T share) {
    // Halves, so that no difference overflows.
    const T difference = T(0.5) * other - T(0.5) * here;
    const T step = difference * (T(2) * share);
    return here + (difference == difference ? step : T(0));
}

/// Makes a row of thin voxels of one of voxels and what lies before and behind it.
template <typename T>
inline void mixHalves(const T* row, T* thin) {
    for (int v = 0; v < 8; ++v) {
        thin[2 * v] = mixed(row[v + 1], row[v], T(0.25));
        thin[2 * v + 1] = mixed(row[v + 1], row[v + 2], T(0.25));
    }
}

/// Mixes the values of the thin voxels that those of a block become: calls use(part, place, values)
/// for rows along v of 8, where `part` is [along u][along slices][along v] and place 64 slice + 8
/// u.
/// @param values  as MixWindow::slots, NaN where there are none
template <typename T, typename Use>
void mixRows(const std::array<T, MixWindow::kSide * MixWindow::kPlane>& values,
             const Subdivision& parts, const Use& use) {
    constexpr int kSide = MixWindow::kSide;
    constexpr int kPlane = MixWindow::kPlane;
    std::array<T, kPlane> plane;
    std::array<T, kSide> row;
    std::array<T, 16> thin;
    for (int s = 0; s < 8 * parts.slices; ++s) {
        // How far from the voxels' middle, in halves of a thin slice.
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
