// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9, and Lee Westover, "Footprint Evaluation for Volume Rendering", 1990, for the sheet.
// Walks the delta grid's leaves and their mask words; a plane of slots remembers what each voxel of
// the current slice is.
#include "splat/splatter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "delta/delta_tree.h"

namespace deltasplat {
namespace {

using Leaf = DeltaTree::Leaf;

// Splats the slices of one slab into one sheet.
class SlabSplatter {
  public:
    SlabSplatter(const SplatInput& input, const Slab& slab, Sheet& sheet)
        : input_(input),
          slab_(slab),
          sheet_(sheet),
          entries_(input.classes.entries.data()),
          leaves_(input.grid.tree->leaves) {
        const IndexBox& box = input.grid.box;
        firstBlock_ = {box.min.y >> 3, box.min.z >> 3};
        blocks_ = glm::ivec2{box.max.y >> 3, box.max.z >> 3} - firstBlock_ + 1;
        for (int n = 0; n < 64; ++n) {
            placeInBlock_[n] =
                std::uint32_t((std::size_t(n & 7) * sheet.layout().pitchPixels() + (n >> 3)) *
                              sheet.layout().resolution);
        }
        if (!slab.whole) slots_.resize(std::size_t{64} * blocks_.x * blocks_.y);
    }

    std::uint64_t run(const std::function<void(int, const Sheet&)>& eachSlice) {
        for (int slice = slab_.firstSlice; slice < slab_.firstSlice + slab_.sliceCount; ++slice) {
            if (slab_.whole) sheet_.clear();
            splatSlice(slice);
            flush();
            sheet_.settle();
            eachSlice(slice, sheet_);
        }
        return stamps_;
    }

  private:
    void splatSlice(int slice) {
        const std::span<const Leaf* const> leaves = leavesOfBlock(slice >> 3);
        const int s = slice & 7;
        if (input_.stampEmptyVoxels) return addEveryVoxel(leaves, s);
        for (const Leaf* leaf : leaves) {
            const std::uint64_t word = leaf->getValueMask().getWord<std::uint64_t>(s);
            if (word == 0) continue;
            const glm::ivec2 block = blockOf(*leaf);
            makeRoom();
            touchBlock(block, word);
            const LeafSlice leafSlice{leaf->buffer().data() + 64 * s, word, placeOf(block),
                                      placeInBlock_.data()};
            if (slab_.whole) {
                listWhole(leafSlice, entries_, list_);
            } else {
                listChanges(leafSlice, entries_, slotsOf(block), list_);
            }
        }
    }

    std::span<const Leaf* const> leavesOfBlock(int block) const {
        const auto first =
            std::lower_bound(leaves_.begin(), leaves_.end(), 8 * block,
                             [](const Leaf* leaf, int x) { return leaf->origin().x() < x; });
        const auto last =
            std::upper_bound(first, leaves_.end(), 8 * block,
                             [](int x, const Leaf* leaf) { return x < leaf->origin().x(); });
        return {first, last};
    }

    glm::ivec2 blockOf(const Leaf& leaf) const {
        return glm::ivec2{leaf.origin().y() >> 3, leaf.origin().z() >> 3} - firstBlock_;
    }
    std::uint32_t placeOf(glm::ivec2 block) const {
        return std::uint32_t(sheet_.layout().stampPlace(sheet_.layout().firstVoxel + 8 * block,
                                                        input_.footprintRadius));
    }
    Slot* slotsOf(glm::ivec2 block) {
        return &slots_[std::size_t{64} * (std::size_t(block.x) * blocks_.y + block.y)];
    }

    // Tells the sheet which pixels the voxels of a mask word reach.
    void touchBlock(glm::ivec2 block, std::uint64_t word) {
        const int firstU = std::countr_zero(word) >> 3;
        const int lastU = (63 - std::countl_zero(word)) >> 3;
        word |= word >> 32;
        word |= word >> 16;
        word |= word >> 8;
        const auto columns = std::uint8_t(word);
        const int firstV = std::countr_zero(columns);
        const int lastV = 7 - std::countl_zero(columns);
        const SheetLayout& layout = sheet_.layout();
        const int radius = input_.footprintRadius;
        const glm::ivec2 origin = 8 * layout.resolution * block + layout.marginPixels;
        sheet_.touch(origin + layout.resolution * glm::ivec2(firstU, firstV) - radius,
                     origin + layout.resolution * glm::ivec2(lastU, lastV) + radius);
    }

    // Stamps all voxels of the slice that lie in the box, leaf or no leaf.
    void addEveryVoxel(std::span<const Leaf* const> leaves, int s) {
        static constexpr std::array<std::int32_t, 64> kNothing{};
        auto leaf = leaves.begin();
        for (int u = 0; u < blocks_.x; ++u) {
            for (int v = 0; v < blocks_.y; ++v) {
                const std::int32_t* values = kNothing.data();
                if (leaf != leaves.end() && blockOf(**leaf) == glm::ivec2(u, v)) {
                    values = (*leaf)->buffer().data() + 64 * s;
                    ++leaf;
                }
                const std::uint64_t word = voxelsInBox({u, v});
                makeRoom();
                touchBlock({u, v}, word);
                listWhole({values, word, placeOf({u, v}), placeInBlock_.data()}, entries_, list_);
            }
        }
    }

    // Returns a mask word of a block's voxels that lie in the box.
    std::uint64_t voxelsInBox(glm::ivec2 block) const {
        const glm::ivec2 first = 8 * (firstBlock_ + block);
        std::uint64_t word = 0;
        for (int n = 0; n < 64; ++n) {
            const int u = first.x + (n >> 3);
            const int v = first.y + (n & 7);
            const IndexBox& box = input_.grid.box;
            const bool inside =
                u >= box.min.y && u <= box.max.y && v >= box.min.z && v <= box.max.z;
            word |= std::uint64_t{inside} << n;
        }
        return word;
    }

    void makeRoom() {
        if (list_.count + 64 > StampList::kCapacity) flush();
    }
    void flush() {
        stamps_ += list_.count;
        addStamps(sheet_.pixels(), sheet_.layout().pitchPixels(), input_.weights, list_);
    }

    const SplatInput& input_;
    const Slab& slab_;
    Sheet& sheet_;
    const std::array<std::uint16_t, 4>* entries_;  // the class table
    std::span<const Leaf* const> leaves_;
    glm::ivec2 firstBlock_;
    glm::ivec2 blocks_;
    std::array<std::uint32_t, 64>
        placeInBlock_;         // of a voxel's footprint, from its block's first one
    std::vector<Slot> slots_;  // of the current slice, [block u][block v][64]
    StampList list_;
    std::uint64_t stamps_ = 0;
};

}  // namespace

std::uint64_t splatSlab(const SplatInput& input, const Slab& slab, Sheet& sheet,
                        const std::function<void(int, const Sheet&)>& eachSlice) {
    return SlabSplatter(input, slab, sheet).run(eachSlice);
}

}  // namespace deltasplat
