// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equations 6 and 9: a slice is the slice before it plus what changed. Here the changes are codes
// rather than colours, so that one grid serves every transfer function, and they lie in an OpenVDB
// grid whose x axis is the slice number.
#include "deltasplat/delta/delta_grid.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <string>

#include "delta/code_blocks.h"
#include "delta/delta_tree.h"
#include "deltasplat/error.h"
#include "parallel.h"

namespace deltasplat {
namespace {

using Leaf = DeltaTree::Leaf;

constexpr int kBlocksPerTask = 64;

// Where slabs begin and end, in blocks of 8 slices.
struct SlabLayout {
    int firstBlock = 0;  // of the first slab
    int blocksPerSlab = 1;
    int lastBlock = 0;  // that has slices
    int lastSlice = 0;

    int slabOf(int block) const { return (block - firstBlock) / blocksPerSlab; }
    bool startsSlab(int block) const { return (block - firstBlock) % blocksPerSlab == 0; }
    int count() const { return slabOf(lastBlock) + 1; }
    // Behind the last slice nothing needs to be taken away.
    int slicesOf(int block) const { return std::min(8, lastSlice + 1 - 8 * block); }
};

SlabLayout layoutOf(const IndexBox& box, int keyInterval) {
    return {box.min.x >> 3, keyInterval / 8, box.max.x >> 3, box.max.x};
}

// The bit 8 * u + v of word s is set where the slot is not empty.
std::uint64_t visibleWord(const Slot* slice) {
    std::uint64_t word = 0;
    for (int n = 0; n < 64; ++n) word |= std::uint64_t{slice[n] != kEmptySlot} << n;
    return word;
}

std::uint64_t changedWord(const Slot* slice, const Slot* before) {
    std::uint64_t word = 0;
    for (int n = 0; n < 64; ++n) word |= std::uint64_t{slice[n] != before[n]} << n;
    return word;
}

// A block with the slice before it: everything that its deltas depend on.
struct BlockWindow {
    std::array<Slot, 64> before{};  // empty where a slab starts or nothing lies there
    BlockSlots slots;

    const Slot* slice(int s) const { return &slots[64 * s]; }
    const Slot* sliceBefore(int s) const { return s == 0 ? before.data() : slice(s - 1); }
};

// Walks a volume's blocks in parallel, each with its neighbourhood along the slice axis.
class BlockWalk {
  public:
    BlockWalk(const BlockReader& reader, const SlabLayout& layout)
        : reader_(reader), layout_(layout) {}

    // Calls visit(task, position, window) for every block that can hold deltas or visible voxels;
    // calls of one task come one after the other, in the order of blocks.
    template <typename Visit>
    void run(const Visit& visit) const {
        parallelFor(tasks(), [&](std::size_t task) {
            const std::size_t end =
                std::min<std::size_t>((task + 1) * kBlocksPerTask, reader_.blocks().size());
            for (std::size_t i = task * kBlocksPerTask; i < end; ++i) visitBlock(task, i, visit);
        });
    }
    std::size_t tasks() const {
        return (reader_.blocks().size() + kBlocksPerTask - 1) / kBlocksPerTask;
    }

  private:
    bool follows(std::size_t i, const glm::ivec3& position) const {
        return i < reader_.blocks().size() &&
               reader_.blocks()[i].position == position + glm::ivec3(1, 0, 0);
    }

    template <typename Visit>
    void visitBlock(std::size_t task, std::size_t i, const Visit& visit) const {
        const CodeBlock& block = reader_.blocks()[i];
        BlockWindow window;
        if (i > 0 && follows(i, reader_.blocks()[i - 1].position) &&
            !layout_.startsSlab(block.position.x)) {
            reader_.readLastSlice(reader_.blocks()[i - 1], window.before);
        }
        reader_.readBlock(block, window.slots);
        visit(task, block.position, window);

        // What ends with this block must be taken away in the next one, even if nothing else is
        // there.
        const glm::ivec3 next = block.position + glm::ivec3(1, 0, 0);
        if (next.x > layout_.lastBlock || layout_.startsSlab(next.x) ||
            follows(i + 1, block.position)) {
            return;
        }
        std::copy_n(window.slice(7), 64, window.before.begin());
        window.slots.fill(kEmptySlot);
        visit(task, next, window);
    }

    const BlockReader& reader_;
    SlabLayout layout_;
};

// Counts visible voxels and deltas of every slab.
std::vector<SliceCounts> countSlabs(const BlockWalk& walk, const SlabLayout& layout) {
    std::vector<std::atomic<std::uint64_t>> visible(layout.count());
    std::vector<std::atomic<std::uint64_t>> deltas(layout.count());
    walk.run([&](std::size_t, const glm::ivec3& position, const BlockWindow& window) {
        const int slab = layout.slabOf(position.x);
        std::uint64_t visibleHere = 0;
        std::uint64_t deltasHere = 0;
        for (int s = 0; s < layout.slicesOf(position.x); ++s) {
            visibleHere += std::popcount(visibleWord(window.slice(s)));
            deltasHere += std::popcount(changedWord(window.slice(s), window.sliceBefore(s)));
        }
        visible[slab].fetch_add(visibleHere, std::memory_order_relaxed);
        deltas[slab].fetch_add(deltasHere, std::memory_order_relaxed);
    });
    std::vector<SliceCounts> counts(layout.count());
    for (int i = 0; i < layout.count(); ++i) counts[i] = {visible[i], deltas[i]};
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

// Returns the leaf of a block's deltas, or of its whole slices; none if it would have no active
// voxel.
std::unique_ptr<Leaf> makeLeaf(const glm::ivec3& position, const BlockWindow& window, int slices,
                               bool whole) {
    std::array<std::uint64_t, 8> words{};
    std::uint64_t any = 0;
    for (int s = 0; s < slices; ++s) {
        words[s] = whole ? visibleWord(window.slice(s))
                         : changedWord(window.slice(s), window.sliceBefore(s));
        any |= words[s];
    }
    if (any == 0) return nullptr;
    auto leaf = std::make_unique<Leaf>(
        openvdb::Coord(8 * position.x, 8 * position.y, 8 * position.z), 0, false);
    std::int32_t* values = leaf->buffer().data();
    Leaf::NodeMaskType mask;
    for (int s = 0; s < slices; ++s) {
        mask.getWord<std::uint64_t>(s) = words[s];
        const Slot* slice = window.slice(s);
        const Slot* before = window.sliceBefore(s);
        for (int n = 0; n < 64; ++n) *values++ = whole ? slice[n] : slice[n] - before[n];
    }
    leaf->setValueMask(mask);
    return leaf;
}

std::shared_ptr<DeltaTree> makeTree(const BlockWalk& walk, const SlabLayout& layout,
                                    const std::vector<Slab>& slabs) {
    std::vector<std::vector<std::unique_ptr<Leaf>>> made(walk.tasks());
    walk.run([&](std::size_t task, const glm::ivec3& position, const BlockWindow& window) {
        const bool whole = slabs[layout.slabOf(position.x)].whole;
        if (auto leaf = makeLeaf(position, window, layout.slicesOf(position.x), whole)) {
            made[task].push_back(std::move(leaf));
        }
    });
    auto tree = std::make_shared<DeltaTree>();
    for (auto& leaves : made) {
        for (auto& leaf : leaves) {
            tree->leaves.push_back(leaf.get());
            tree->grid->tree().addLeaf(leaf.release());
        }
    }
    std::sort(tree->leaves.begin(), tree->leaves.end(),
              [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
    return tree;
}

IndexBox permutedBox(const IndexBox& box, int sliceAxis) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    return {{box.min[order[0]], box.min[order[1]], box.min[order[2]]},
            {box.max[order[0]], box.max[order[1]], box.max[order[2]]}};
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
    return std::clamp((sliceCount + 127) / 128 * 8, 8, 64);
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
    if (volume.empty()) return grid;

    const SlabLayout layout = layoutOf(grid.box, grid.keyInterval);
    const BlockReader reader(*volume.codes, options.sliceAxis, options.slotMap);
    const BlockWalk walk(reader, layout);
    grid.slabs = makeSlabs(grid.box, layout, countSlabs(walk, layout), options.encoding);
    grid.tree = makeTree(walk, layout, grid.slabs);
    return grid;
}

SliceCounts countDeltas(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    if (volume.empty()) return {};
    const IndexBox box = permutedBox(volume.box, sliceAxis);
    SlabLayout layout = layoutOf(box, 8);
    layout.blocksPerSlab = layout.lastBlock - layout.firstBlock + 1;
    const BlockReader reader(*volume.codes, sliceAxis, slotMap);
    return countSlabs(BlockWalk(reader, layout), layout)[0];
}

}  // namespace deltasplat
