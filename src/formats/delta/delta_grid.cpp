// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equations 6 and 9: a slice is the slice before it plus its changes. Here changes are codes
// instead of colours, so that one grid serves every transfer function. They lie in an OpenVDB grid
// whose x axis is the slice number.
#include "formats/delta/delta_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/delta/delta_grid.h"
#include "deltasplat/error.h"
#include "volume/block_kernels.h"
#include "volume/leaf_slices.h"

namespace deltasplat {

namespace {

using Leaf = DeltaTree::Leaf;

// The changes of a volume along one axis, block by block.
struct Differences {
    SlabLayout layout;
    BlockReader reader;
    BlockWindows windows;
    std::vector<BlockChanges> changes;

    Differences(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap,
                const SlabLayout& slabs, const CodeTree* inactive = nullptr)
        : layout(slabs),
          reader(*volume.codes(), inactive, sliceAxis, slotMap),
          windows(reader, layout),
          changes(findChanges(windows, layout)) {}
    // The windows refer to the reader.
    Differences(const Differences&) = delete;
    Differences& operator=(const Differences&) = delete;

    int slabOf(std::size_t i) const { return layout.slabOf(windows.position(i).x); }
};

std::vector<SliceCounts> countSlabs(const Differences& differences) {
    std::vector<SliceCounts> counts(differences.layout.count());
    for (std::size_t i = 0; i < differences.changes.size(); ++i) {
        counts[differences.slabOf(i)] +=
            {countBits(differences.changes[i].visible), countBits(differences.changes[i].changed)};
    }
    return counts;
}

std::vector<Slab> makeSlabs(const Differences& differences, const IndexBox& box) {
    const std::vector<SliceCounts> counts = countSlabs(differences);
    std::vector<Slab> slabs(counts.size());
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        placeSlab(box, differences.layout, int(i), slabs[i]);
        slabs[i].visible = counts[i].visible;
        slabs[i].deltas = counts[i].deltas;
    }
    return slabs;
}

// Returns the leaf of a block's deltas, which are active in `words`.
std::unique_ptr<Leaf> makeLeaf(const glm::ivec3& position, const BlockWindow& window,
                               const std::array<std::uint64_t, 8>& words) {
    auto leaf = std::make_unique<Leaf>(
        openvdb::Coord(8 * position.x, 8 * position.y, 8 * position.z), 0, false);
    std::int32_t* values = leaf->buffer().data();
    Leaf::NodeMaskType mask;
    for (int s = 0; s < 8; ++s, values += 64) {
        mask.getWord<std::uint64_t>(s) = words[s];
        if (words[s] == 0) continue;
        const Slot* slice = window.slice(s);
        const Slot* before = window.sliceBefore(s);
        for (int n = 0; n < 64; ++n) values[n] = slice[n] - before[n];
    }
    leaf->setValueMask(mask);
    return leaf;
}

std::shared_ptr<DeltaTree> makeTree(const Differences& differences) {
    const BlockWindows& windows = differences.windows;
    const auto& changes = differences.changes;
    std::size_t needed = 0;
    for (const BlockChanges& block : changes) needed += countBits(block.changed) != 0;
    requireMemory("delta grid", double(needed) * leafBytes<Leaf>());

    std::vector<std::unique_ptr<Leaf>> leaves(windows.count());
    parallelForChunks(windows.count(), [&](std::size_t begin, std::size_t end) {
        BlockWindow window;
        for (std::size_t i = begin; i < end; ++i) {
            if (countBits(changes[i].changed) == 0) continue;
            windows.read(i, window);
            leaves[i] = makeLeaf(windows.position(i), window, changes[i].changed);
        }
    });
    auto tree = std::make_shared<DeltaTree>();
    for (auto& leaf : leaves) {
        if (!leaf) continue;
        tree->leaves.push_back(leaf.get());
        tree->deltas->addLeaf(leaf.release());
    }
    std::sort(tree->leaves.begin(), tree->leaves.end(),
              [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
    return tree;
}

// Returns the facts that need no voxels.
DeltaGrid gridWithoutSlabs(const Volume& volume, const DeltaOptions& options) {
    DeltaGrid grid;
    grid.sliceAxis = options.sliceAxis;
    grid.box = permutedBox(volume.box(), options.sliceAxis);
    grid.keyInterval =
        options.keyInterval != 0 ? options.keyInterval : defaultKeyInterval(grid.box.dims().x);
    if (grid.keyInterval < 8 || grid.keyInterval % 8 != 0) {
        throw Error(ErrorCode::kUsage, "key interval", std::to_string(grid.keyInterval),
                    "a positive multiple of 8");
    }
    grid.tree = std::make_shared<DeltaTree>();
    return grid;
}

}  // namespace

std::uint64_t DeltaGrid::visible() const {
    return sumOf(slabs, &Slab::visible);
}

std::uint64_t DeltaGrid::deltas() const {
    return sumOf(slabs, &Slab::deltas);
}

int defaultKeyInterval(int sliceCount) {
    return 8 * std::max(16, sliceCount / 128 + (sliceCount % 128 != 0));
}

DeltaGrid makeDeltaGrid(const Volume& volume, const DeltaOptions& options) {
    DeltaGrid grid = gridWithoutSlabs(volume, options);
    // A volume without active voxels may still have inactive values.
    if (grid.box.empty()) return grid;
    const Differences differences(volume, options.sliceAxis, options.slotMap,
                                  layoutOf(grid.box, grid.keyInterval), options.inactive);
    grid.slabs = makeSlabs(differences, grid.box);
    grid.tree = makeTree(differences);
    return grid;
}

// Uses one slab, not a count per slice: few voxels far apart span more slices than memory holds.
SliceCounts countDeltas(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    if (volume.empty()) return {};
    const IndexBox box = permutedBox(volume.box(), sliceAxis);
    return countSlabs(Differences(volume, sliceAxis, slotMap, oneSlab(box)))[0];
}

std::vector<SliceCounts> countDeltasPerSlice(const Volume& volume, int sliceAxis,
                                             std::span<const Slot> slotMap, int slicesEach) {
    if (volume.empty()) return {};
    const IndexBox box = permutedBox(volume.box(), sliceAxis);
    const std::size_t entries = std::size_t(box.dims().x - 1) / slicesEach + 1;
    requireMemory("counts of every slice", double(entries) * sizeof(SliceCounts));
    std::vector<SliceCounts> counts(entries);
    const Differences differences(volume, sliceAxis, slotMap, oneSlab(box));
    for (std::size_t i = 0; i < differences.changes.size(); ++i) {
        const int block = differences.windows.position(i).x;
        const int before = std::max(0, box.min.x - 8 * block);
        for (int s = before; s < differences.layout.slicesOf(block); ++s) {
            SliceCounts& entry = counts[(8 * block + s - box.min.x) / slicesEach];
            entry.visible += std::popcount(differences.changes[i].visible[s]);
            entry.deltas += std::popcount(differences.changes[i].changed[s]);
        }
    }
    return counts;
}

BlockWindows::BlockWindows(const BlockReader& reader, const SlabLayout& layout)
    : reader_(reader), layout_(layout) {
    const std::vector<CodeBlock>& blocks = reader.blocks();
    places_.reserve(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        places_.push_back({i, false});
        const int next = blocks[i].position.x + 1;
        const bool ends = next <= layout.lastBlock && !layout.startsSlab(next);
        if (ends && !continues(i + 1)) places_.push_back({i, true});
    }
}

bool BlockWindows::continues(std::size_t i) const {
    const std::vector<CodeBlock>& blocks = reader_.blocks();
    return i > 0 && i < blocks.size() && follows(blocks[i - 1], blocks[i]) &&
           !layout_.startsSlab(blocks[i].position.x);
}

void BlockWindows::read(std::size_t i, BlockWindow& window) const {
    const Place place = places_[i];
    const std::vector<CodeBlock>& blocks = reader_.blocks();
    if (place.behind) {
        reader_.readLastSlice(blocks[place.block], window.before);
        window.slots.fill(kEmptySlot);
        return;
    }
    if (continues(place.block)) {
        reader_.readLastSlice(blocks[place.block - 1], window.before);
    } else {
        window.before.fill(kEmptySlot);
    }
    reader_.readBlock(blocks[place.block], window.slots);
}

std::vector<BlockChanges> findChanges(const BlockWindows& windows, const SlabLayout& layout) {
    static constexpr std::array<Slot, 64> kEmptySlice{};
    std::vector<BlockChanges> changes(windows.count());
    parallelForChunks(windows.count(), [&](std::size_t begin, std::size_t end) {
        BlockWindow window;
        for (std::size_t i = begin; i < end; ++i) {
            windows.read(i, window);
            for (int s = 0; s < layout.slicesOf(windows.position(i).x); ++s) {
                changes[i].visible[s] = differingSlots(window.slice(s), kEmptySlice.data());
                changes[i].changed[s] = differingSlots(window.slice(s), window.sliceBefore(s));
            }
        }
    });
    return changes;
}

}  // namespace deltasplat
