// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equations 6 and 9: a slice is the slice before it plus what changed. Here the changes are codes
// rather than colours, so that one grid serves every transfer function, and they lie in an OpenVDB
// grid whose x axis is the slice number.
#include "deltasplat/delta/delta_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <numeric>
#include <string>

#include "delta/block_windows.h"
#include "delta/delta_tree.h"
#include "deltasplat/error.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

using Leaf = DeltaTree::Leaf;

std::uint64_t countBits(const std::array<std::uint64_t, 8>& words) {
    std::uint64_t count = 0;
    for (const std::uint64_t word : words) count += std::popcount(word);
    return count;
}

// Counts visible voxels and deltas of every slab.
std::vector<SliceCounts> countSlabs(const BlockWindows& windows,
                                    const std::vector<BlockChanges>& changes,
                                    const SlabLayout& layout) {
    std::vector<SliceCounts> counts(layout.count());
    for (std::size_t i = 0; i < changes.size(); ++i) {
        SliceCounts& slab = counts[layout.slabOf(windows.position(i).x)];
        slab.visible += countBits(changes[i].visible);
        slab.deltas += countBits(changes[i].changed);
    }
    return counts;
}

std::vector<Slab> makeSlabs(const IndexBox& box, const SlabLayout& layout,
                            const std::vector<SliceCounts>& counts, Encoding encoding) {
    std::vector<Slab> slabs(layout.count());
    for (int i = 0; i < layout.count(); ++i) {
        const int begin = 8 * (layout.firstBlock + i * layout.blocksPerSlab);
        Slab& slab = slabs[i];
        slab.firstSlice = std::max(begin, box.min.x);
        slab.sliceCount =
            std::min(begin + 8 * layout.blocksPerSlab, box.max.x + 1) - slab.firstSlice;
        slab.visible = counts[i].visible;
        slab.deltas = counts[i].deltas;
        slab.whole = encoding == Encoding::kWhole ||
                     (encoding == Encoding::kSmaller && slab.visible < slab.deltas);
    }
    return slabs;
}

// Returns the leaf of a block's deltas, or of its whole slices, active where `words` says so.
std::unique_ptr<Leaf> makeLeaf(const glm::ivec3& position, const BlockWindow& window,
                               const std::array<std::uint64_t, 8>& words, bool whole) {
    auto leaf = std::make_unique<Leaf>(
        openvdb::Coord(8 * position.x, 8 * position.y, 8 * position.z), 0, false);
    std::int32_t* values = leaf->buffer().data();
    Leaf::NodeMaskType mask;
    for (int s = 0; s < 8; ++s, values += 64) {
        mask.getWord<std::uint64_t>(s) = words[s];
        if (words[s] == 0) continue;
        const Slot* slice = window.slice(s);
        const Slot* before = window.sliceBefore(s);
        for (int n = 0; n < 64; ++n) values[n] = whole ? slice[n] : slice[n] - before[n];
    }
    leaf->setValueMask(mask);
    return leaf;
}

std::shared_ptr<DeltaTree> makeTree(const BlockWindows& windows,
                                    const std::vector<BlockChanges>& changes,
                                    const SlabLayout& layout, const std::vector<Slab>& slabs) {
    const auto wordsOf = [&](std::size_t i) -> const std::array<std::uint64_t, 8>& {
        return slabs[layout.slabOf(windows.position(i).x)].whole ? changes[i].visible
                                                                 : changes[i].changed;
    };
    std::size_t needed = 0;
    for (std::size_t i = 0; i < windows.count(); ++i) needed += countBits(wordsOf(i)) != 0;
    requireMemory("delta grid", double(needed) * (sizeof(Leaf) + Leaf::NUM_VALUES * sizeof(Slot)));

    std::vector<std::unique_ptr<Leaf>> leaves(windows.count());
    parallelForChunks(windows.count(), [&](std::size_t begin, std::size_t end) {
        BlockWindow window;
        for (std::size_t i = begin; i < end; ++i) {
            if (countBits(wordsOf(i)) == 0) continue;
            windows.read(i, window);
            const bool whole = slabs[layout.slabOf(windows.position(i).x)].whole;
            leaves[i] = makeLeaf(windows.position(i), window, wordsOf(i), whole);
        }
    });
    auto tree = std::make_shared<DeltaTree>();
    for (auto& leaf : leaves) {
        if (!leaf) continue;
        tree->leaves.push_back(leaf.get());
        tree->grid->tree().addLeaf(leaf.release());
    }
    std::sort(tree->leaves.begin(), tree->leaves.end(),
              [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
    return tree;
}

}  // namespace

std::uint64_t DeltaGrid::visible() const {
    return std::accumulate(slabs.begin(), slabs.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Slab& slab) { return sum + slab.visible; });
}

std::uint64_t DeltaGrid::deltas() const {
    return std::accumulate(slabs.begin(), slabs.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Slab& slab) { return sum + slab.deltas; });
}

int defaultKeyInterval(int sliceCount) {
    return 8 * std::max(1, sliceCount / 128 + (sliceCount % 128 != 0));
}

DeltaGrid makeDeltaGrid(const Volume& volume, const DeltaOptions& options) {
    DeltaGrid grid;
    grid.sliceAxis = options.sliceAxis;
    grid.box = permutedBox(volume.box, options.sliceAxis);
    grid.keyInterval =
        options.keyInterval != 0 ? options.keyInterval : defaultKeyInterval(grid.box.dims().x);
    if (grid.keyInterval < 8 || grid.keyInterval % 8 != 0) {
        throw Error(ErrorCode::kUsage, gotExpected("key interval", std::to_string(grid.keyInterval),
                                                   "a positive multiple of 8"));
    }
    grid.tree = std::make_shared<DeltaTree>();
    if (grid.box.empty()) return grid;

    const SlabLayout layout = layoutOf(grid.box, grid.keyInterval);
    const BlockReader reader(*volume.codes, options.inactive, options.sliceAxis, options.slotMap);
    const BlockWindows windows(reader, layout);
    const std::vector<BlockChanges> changes = findChanges(windows, layout);
    grid.slabs =
        makeSlabs(grid.box, layout, countSlabs(windows, changes, layout), options.encoding);
    grid.tree = makeTree(windows, changes, layout, grid.slabs);
    return grid;
}

SliceCounts countDeltas(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    if (volume.empty()) return {};
    const IndexBox box = permutedBox(volume.box, sliceAxis);
    SlabLayout layout = layoutOf(box, 8);
    layout.blocksPerSlab = layout.lastBlock - layout.firstBlock + 1;
    const BlockReader reader(*volume.codes, nullptr, sliceAxis, slotMap);
    const BlockWindows windows(reader, layout);
    return countSlabs(windows, findChanges(windows, layout), layout)[0];
}

}  // namespace deltasplat
