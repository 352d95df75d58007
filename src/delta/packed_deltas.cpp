// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9. Deviates in that a change is kept as what a voxel becomes: what it was is known to
// who walks the slices in order.
#include "delta/packed_deltas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>

#include "delta/block_kernels.h"
#include "delta/block_windows.h"
#include "delta/code_blocks.h"
#include "delta/mixed_sight.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

// Classes of a block, `[slice][u][v]`, and of one slice of it.
using BlockClasses = std::array<ClassIndex, 512>;
using SliceClasses = std::array<ClassIndex, 64>;

// Reads a leaf, kStep: how far neighbours along x, y and z lie in `out`.
template <int kStepX, int kStepY, int kStepZ, typename SlotOf, typename Out>
void readLeafInSteps(const CodeTree::Leaf& leaf, const SlotOf& slotOf, Out* out) {
    const Code* codes = leaf.buffer().data();
    for (int x = 0; x < 8; ++x) {
        for (int y = 0; y < 8; ++y) {
            for (int z = 0; z < 8; ++z) {
                out[x * kStepX + y * kStepY + z * kStepZ] = Out(slotOf(*codes++));
            }
        }
    }
    if (leaf.isDense()) return;
    for (int x = 0; x < 8; ++x) {
        std::uint64_t inactive = ~leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(x));
        for (; inactive != 0; inactive &= inactive - 1) {
            const int n = std::countr_zero(inactive);
            out[x * kStepX + (n >> 3) * kStepY + (n & 7) * kStepZ] = kEmptySlot;
        }
    }
}

// Reads a leaf in (slice, u, v) order.
template <typename SlotOf, typename Out>
void readLeaf(const CodeTree::Leaf& leaf, int sliceAxis, const SlotOf& slotOf, Out* out) {
    if (sliceAxis == 0) return readLeafInSteps<64, 8, 1>(leaf, slotOf, out);
    if (sliceAxis == 1) return readLeafInSteps<1, 64, 8>(leaf, slotOf, out);
    readLeafInSteps<8, 1, 64>(leaf, slotOf, out);
}

// Calls use(slotOf) with what a code's slot is under a map.
inline auto mapped(std::span<const Slot> slotMap) {
    return [map = slotMap.data()](Code code) { return map[code + 1]; };
}

// Holds voxels along the slice axis. Slots that are seen are numbered, 0 for all others; what a
// voxel goes on as is looked up if there are few of them, and asked for otherwise.
class Holder {
  public:
    Holder(const Volume& volume, const PackOptions& options) : options_(options) {
        std::vector<Slot> slots{kEmptySlot};
        for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
            const Slot slot = Slot(code + 1);
            if (volume.histogram[code] != 0 && options.classOfSlot[slot] != kEmptySlot)
                slots.push_back(slot);
        }
        numberOf_.resize(kSlotCount);
        for (std::size_t i = 0; i < slots.size(); ++i) numberOf_[slots[i]] = Slot(i);
        for (const Slot slot : slots) classOf_.push_back(ClassIndex(options.classOfSlot[slot]));
        slots_ = std::move(slots);
        if (slots_.size() > kMostInTable) return;
        next_.resize(slots_.size() * slots_.size());
        for (std::size_t held = 0; held < slots_.size(); ++held) {
            for (std::size_t slot = 0; slot < slots_.size(); ++slot)
                next_[held * slots_.size() + slot] = std::uint16_t(ask(Slot(held), Slot(slot)));
        }
    }

    // [kSlotCount]: the number of each slot.
    std::span<const Slot> numberOfSlot() const { return numberOf_; }
    ClassIndex classOf(Slot number) const { return classOf_[number]; }
    // Returns what a voxel goes on as.
    Slot next(Slot held, Slot slot) const {
        return next_.empty() ? ask(held, slot)
                             : next_[std::size_t(held) * slots_.size() + std::size_t(slot)];
    }

  private:
    static constexpr std::size_t kMostInTable = 512;

    // Slots of one class need no tolerance: the later one goes on.
    Slot ask(Slot held, Slot slot) const {
        const bool keeps = held != 0 && slot != 0 && classOf_[held] != classOf_[slot] &&
                           options_.holds(slots_[held], slots_[slot]);
        return keeps ? held : slot;
    }

    const PackOptions& options_;
    std::vector<Slot> numberOf_;
    std::vector<Slot> slots_;          // by number
    std::vector<ClassIndex> classOf_;  // likewise
    std::vector<std::uint16_t> next_;  // [held][slot], or empty
};

// A word before all words are in one place.
struct PendingWord {
    std::uint64_t visible;
    std::uint64_t changed;
    std::size_t classes;  // where they begin in the packer's storage
    int slice;
    glm::ivec2 block;
};

// Words that a block may make: its slices, and one behind it that takes away what it showed.
constexpr std::size_t kMostWords = 9;
constexpr double kBytesPerBlock =
    kMostWords * (sizeof(DeltaWord) + sizeof(PendingWord) + sizeof(SliceClasses));

// How voxels become classes. Null: as they are.
struct PackTools {
    const Holder* holder = nullptr;
    const SliceMixer* mixer = nullptr;
    const MixedSight* sight = nullptr;
};

// Packs columns of blocks (same u and v), slices in increasing order.
class ColumnPacker {
  public:
    ColumnPacker(const IndexBox& box, const PackOptions& options, const PackTools& tools,
                 std::span<const Slot> slotMap)
        : options_(options),
          tools_(tools),
          slotMap_(slotMap),
          planner_(box),
          layout_(planner_.shortest()) {}

    // Packs blocks [begin, end), which are whole columns.
    void run(const CodeBlock* begin, const CodeBlock* end) {
        // What is not used of it takes no memory.
        const std::size_t most = kMostWords * std::size_t(perBlock()) * std::size_t(end - begin);
        words_.reserve(most);
        storage_.reserve(64 * most);
        for (const CodeBlock* block = begin; block != end; ++block) {
            const bool isFirst = block == begin || !follows(block);
            const bool isLast = block + 1 == end || !follows(block + 1);
            if (isFirst) {
                before_.fill(kEmptySlot);
                held_.fill(kEmptySlot);
            }
            if (tools_.mixer) {
                addMixed({block - int{!isFirst}, block + 1 + int{!isLast}}, *block);
            } else {
                read(*block);
                add(block->position, layout_.slicesOf(block->position.x));
            }
            // What a block showed must be taken away behind it.
            const int next = (block->position.x + 1) * perBlock();
            if (next > layout_.lastBlock || !isLast) continue;
            classes_.fill(kEmptySlot);
            add({next, block->position.y, block->position.z}, 1);
        }
    }

    const std::vector<PendingWord>& words() const { return words_; }
    std::vector<ClassIndex>& storage() { return storage_; }
    const SlabPlanner& planner() const { return planner_; }

  private:
    static bool follows(const CodeBlock* block) {
        return block->position == block[-1].position + glm::ivec3(1, 0, 0);
    }

    // Blocks of thin slices that a block becomes.
    int perBlock() const { return tools_.mixer ? tools_.mixer->perVoxel() : 1; }

    void read(const CodeBlock& block) {
        if (tools_.holder) {
            readSlots(block, mapped(slotMap_), slots_);
            return hold(slots_);
        }
        if (!block.leaf) return classes_.fill(ClassIndex(block.tileSlot));
        readLeaf(*block.leaf, options_.sliceAxis, mapped(slotMap_), classes_.data());
    }

    template <typename SlotOf>
    void readSlots(const CodeBlock& block, const SlotOf& slotOf, BlockSlots& slots) const {
        if (!block.leaf) return slots.fill(block.tileSlot);
        readLeaf(*block.leaf, options_.sliceAxis, slotOf, slots.data());
    }

    void hold(const BlockSlots& slots) {
        for (std::size_t i = 0; i < slots.size(); ++i) {
            Slot& held = held_[i & 63];
            held = tools_.holder->next(held, slots[i]);
            classes_[i] = tools_.holder->classOf(held);
        }
    }

    // Adds what a block becomes between the one before it and the one behind it, of those that
    // there are in `run`.
    void addMixed(std::span<const CodeBlock> run, const CodeBlock& block) {
        const int parts = perBlock();
        const bool isSeen = tools_.sight->canBeSeen(run);
        if (isSeen) readWindow(run, block);
        for (int part = 0; part < parts; ++part) {
            const glm::ivec3 position(block.position.x * parts + part, block.position.y,
                                      block.position.z);
            const int slices = layout_.slicesOf(position.x);
            if (slices <= 0) return;
            if (isSeen) {
                tools_.mixer->mix(window_, part, slotMap_, slots_);
                showSlots();
            } else {
                classes_.fill(kEmptySlot);
                held_.fill(kEmptySlot);
            }
            add(position, slices);
        }
    }

    void showSlots() {
        if (tools_.holder) return hold(slots_);
        std::copy(slots_.begin(), slots_.end(), classes_.begin());
    }

    void readWindow(std::span<const CodeBlock> run, const CodeBlock& block) {
        const auto slotOf = [](Code code) { return Slot(code + 1); };
        const auto readSlice = [&](const CodeBlock& other, int slice, std::array<Slot, 64>& out) {
            readSlots(other, slotOf, slots_);
            std::copy_n(&slots_[64 * std::size_t(slice)], 64, out.begin());
        };
        window_.before.fill(kEmptySlot);
        window_.behind.fill(kEmptySlot);
        if (&run.front() != &block) readSlice(run.front(), 7, window_.before);
        if (&run.back() != &block) readSlice(run.back(), 0, window_.behind);
        readSlots(block, slotOf, window_.slots);
    }

    // Adds the words of the first `slices` slices of classes_.
    void add(const glm::ivec3& position, int slices) {
        BlockChanges changes;
        compareClasses(before_.data(), classes_.data(), changes.visible.data(),
                       changes.changed.data());
        for (int s = 0; s < slices; ++s) {
            const std::uint64_t visible = changes.visible[s];
            const std::uint64_t changed = changes.changed[s];
            const int slice = 8 * position.x + s;
            const bool isKey = layout_.startsLaterSlab(slice);
            planner_.add(slice, visible, changed);
            const bool needed =
                (options_.encoding != Encoding::kWhole && changed != 0) ||
                ((options_.encoding != Encoding::kChanges || isKey) && visible != 0);
            if (!needed) continue;
            words_.push_back({visible, changed, storage_.size(), slice, {position.y, position.z}});
            storage_.insert(storage_.end(), &classes_[64 * s], &classes_[64 * s] + 64);
        }
        std::copy_n(&classes_[7 * 64], 64, before_.begin());
    }

    const PackOptions& options_;
    PackTools tools_;
    std::span<const Slot> slotMap_;
    SlabPlanner planner_;
    SlabLayout layout_;       // of the shortest slabs that there may be
    BlockClasses classes_{};  // of the block in hand
    SliceClasses before_{};   // of the slice before it
    std::array<Slot, 64> held_{};
    BlockSlots slots_{};
    SliceMixer::Window window_;
    std::vector<PendingWord> words_;
    std::vector<ClassIndex> storage_;
};

// Cuts the blocks into runs of whole columns, for each of which there is one packer. The cuts
// depend on the volume alone.
std::vector<std::size_t> cutAtColumns(const std::vector<CodeBlock>& blocks) {
    const std::size_t least = std::max<std::size_t>(128, blocks.size() / 256);
    std::vector<std::size_t> cuts{0};
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        const bool newColumn = blocks[i].position.y != blocks[i - 1].position.y ||
                               blocks[i].position.z != blocks[i - 1].position.z;
        if (newColumn && i - cuts.back() >= least) cuts.push_back(i);
    }
    if (!blocks.empty()) cuts.push_back(blocks.size());
    return cuts;
}

// Puts the packers' words in the order of slices.
void collectWords(std::vector<ColumnPacker>& packers, const SlabLayout& layout,
                  PackedDeltas& packed) {
    const auto sliceOf = [&](const PendingWord& word) {
        return std::size_t(word.slice - packed.box.min.x);
    };
    const auto changed = [&](const PendingWord& word) {
        return layout.startsLaterSlab(word.slice) ? word.visible : word.changed;
    };
    const auto needed = [&](const PendingWord& word) {
        const bool whole = packed.slabs[layout.slabOf(word.slice >> 3)].whole;
        return (whole ? word.visible : changed(word)) != 0;
    };
    packed.begins.resize(std::size_t(packed.box.dims().x) + 1);
    for (const ColumnPacker& packer : packers) {
        for (const PendingWord& word : packer.words())
            if (needed(word)) ++packed.begins[sliceOf(word) + 1];
    }
    std::partial_sum(packed.begins.begin(), packed.begins.end(), packed.begins.begin());
    packed.words.resize(packed.begins.back());
    std::vector<std::size_t> next(packed.begins.begin(), packed.begins.end() - 1);
    for (ColumnPacker& packer : packers) {
        packed.storage.push_back(std::move(packer.storage()));
        const ClassIndex* classes = packed.storage.back().data();
        for (const PendingWord& word : packer.words()) {
            if (!needed(word)) continue;
            packed.words[next[sliceOf(word)]++] = {word.visible, changed(word),
                                                   classes + word.classes, word.block};
        }
    }
}

}  // namespace

std::uint64_t PackedDeltas::visible() const {
    return sumOf(slabs, &Slab::visible);
}

std::uint64_t PackedDeltas::deltas() const {
    return sumOf(slabs, &Slab::deltas);
}

std::span<const DeltaWord> PackedDeltas::slice(int index) const {
    const auto i = std::size_t(index - box.min.x);
    return std::span(words).subspan(begins[i], begins[i + 1] - begins[i]);
}

IndexBox boxOfSlices(const IndexBox& box, int sliceAxis, int perVoxel) {
    IndexBox slices = permutedBox(box, sliceAxis);
    slices.min.x *= perVoxel;
    slices.max.x = slices.max.x * perVoxel + perVoxel - 1;
    return slices;
}

PackedDeltas packDeltas(const Volume& volume, const PackOptions& options) {
    PackedDeltas packed;
    packed.sliceAxis = options.sliceAxis;
    const SliceMixer* mixer = options.mixer;
    const int perVoxel = mixer ? mixer->perVoxel() : 1;
    packed.box = boxOfSlices(volume.box, options.sliceAxis, perVoxel);
    if (volume.empty()) return packed;
    std::optional<Holder> holder;
    if (options.holds) holder.emplace(mixer ? mixer->levels() : volume, options);
    const std::span<const Slot> slotMap = holder ? holder->numberOfSlot() : options.classOfSlot;
    std::optional<MixedSight> sight;
    if (mixer) sight.emplace(*mixer, slotMap);
    const std::vector<CodeBlock> blocks =
        sight ? sight->listBlocks(*volume.codes, options.sliceAxis, volume.histogram)
              : BlockReader(*volume.codes, nullptr, options.sliceAxis, slotMap).takeBlocks();
    requireMemory("delta grid",
                  double(blocks.size()) * perVoxel * kBytesPerBlock + 16.0 * packed.box.dims().x);

    const std::vector<std::size_t> cuts = cutAtColumns(blocks);
    std::vector<ColumnPacker> packers(
        cuts.size() - 1,
        ColumnPacker(packed.box, options,
                     {holder ? &*holder : nullptr, mixer, sight ? &*sight : nullptr}, slotMap));
    parallelFor(packers.size(), [&](std::size_t i) {
        packers[i].run(blocks.data() + cuts[i], blocks.data() + cuts[i + 1]);
    });
    SlabPlanner planner(packed.box);
    for (const ColumnPacker& packer : packers) planner.add(packer.planner());
    SlabPlan plan = planner.plan(options.encoding);
    packed.slabs = std::move(plan.slabs);
    collectWords(packers, plan.layout, packed);
    return packed;
}

}  // namespace deltasplat
