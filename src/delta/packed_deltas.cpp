// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9. Deviates in that a change is kept as what a voxel becomes: what it was is known to
// who walks the slices in order.
#include "delta/packed_deltas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "delta/block_kernels.h"
#include "delta/block_looks.h"
#include "delta/block_windows.h"
#include "delta/code_blocks.h"
#include "delta/hold_slots.h"
#include "delta/mixed_sight.h"
#include "delta/slab_facts.h"
#include "delta/slot_holder.h"
#include "delta/word_collector.h"
#include "deltasplat/error.h"
#include "ingest/codes/leaf_slices.h"
#include "memory.h"
#include "parallel.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

bool choosesClasses(const PackOptions& options) {
    return options.painter && options.painter->choosesClasses();
}

// Adds blocks in which nothing is seen but what the painter adds, in the order in which they are.
void addBlocks(const BlockSet& more, int sliceAxis, std::vector<CodeBlock>& blocks) {
    const auto isBefore = [](const CodeBlock& a, const CodeBlock& b) {
        const auto key = [](const glm::ivec3& p) { return std::tuple(p.y, p.z, p.x); };
        return key(a.position) < key(b.position);
    };
    std::vector<CodeBlock> added;
    for (const glm::ivec3& position : more.positions)
        added.push_back({toSliceOrder(position, sliceAxis)});
    std::sort(added.begin(), added.end(), isBefore);
    std::vector<CodeBlock> all;
    std::set_union(blocks.begin(), blocks.end(), added.begin(), added.end(),
                   std::back_inserter(all), isBefore);
    blocks = std::move(all);
}

// Classes of a block, `[slice][u][v]`, and of one slice of it.
using BlockClasses = std::array<ClassIndex, 512>;
using SliceClasses = std::array<ClassIndex, 64>;

// Calls use(slotOf) with what a code's slot is under a map.
inline auto mapped(std::span<const Slot> slotMap) {
    return [map = slotMap.data()](Code code) { return map[code + 1]; };
}

// Words that a block may make: its slices, and one behind it that takes away what it showed.
constexpr std::size_t kMostWords = 9;
constexpr double kBytesPerWord = sizeof(DeltaWord) + sizeof(PendingWord) + sizeof(SliceClasses);
constexpr double kBytesPerBlock = kMostWords * kBytesPerWord;
constexpr double kLookBytesPerBlock = kMostWords * 64 * sizeof(OwnLook);

// How voxels become classes. Null: as they are.
struct PackTools {
    const SlotHolder* holder = nullptr;
    const ValueMixer* mixer = nullptr;
    const MixedSight* sight = nullptr;
    const CodeTree* codes = nullptr;  // that values are mixed from
    const CodeTree* uncut = nullptr;  // that gradients are taken of
};

// What a packer packs: columns of blocks (same u and v), slices in increasing order.
struct Columns {
    const CodeBlock* begin;
    const CodeBlock* end;
};

// What of it: all blocks, of which it counts what is in their slices, or those of some slabs.
struct PackRange {
    SlabLayout layout;  // of slabs that there may be
    int firstBlock;
    int lastBlock;
    bool storesWords = true;
};

class ColumnPacker {
  public:
    ColumnPacker(const IndexBox& box, const PackOptions& options, const PackTools& tools,
                 std::span<const Slot> slotMap, const PackRange& range)
        : options_(options),
          tools_(tools),
          slotMap_(slotMap),
          box_(box),
          planner_(box),
          range_(range),
          layout_(range.layout) {
        if (tools.mixer) parts_ = tools.mixer->parts();
        if (!tools.mixer) return;
        window_.emplace(*tools.codes, options.sliceAxis,
                        parts_.within == 1 && !choosesClasses(options));
        if (choosesClasses(options) && tools.uncut != tools.codes)
            uncut_.emplace(*tools.uncut, options.sliceAxis, false);
        const int blocks = parts_.voxels();
        mixed_.resize(std::size_t(blocks));
    }

    void run(const Columns& columns) {
        const auto isIn = [&](const CodeBlock& block) {
            return tools_.mixer ||
                   (block.position.x >= range_.firstBlock && block.position.x <= range_.lastBlock);
        };
        // What is not used of it takes no memory.
        const auto blocks = std::size_t(std::count_if(columns.begin, columns.end, isIn));
        const std::size_t most = !range_.storesWords ? 0
                                                     : kMostWords * std::size_t(parts_.slices) *
                                                           std::size_t(parts_.within) * blocks;
        for (int half = 0; half < parts_.within; ++half) {
            halves_[std::size_t(half)].words.reserve(most);
            halves_[std::size_t(half)].storage.reserve(64 * most);
            if (options_.painter) halves_[std::size_t(half)].looks.reserve(64 * most);
        }
        if (options_.painter) {
            own_ = std::make_unique<BlockLooks>(*options_.painter, *tools_.uncut,
                                                options_.sliceAxis, parts_, box_);
        }
        for (const CodeBlock* block = columns.begin; block != columns.end; ++block) {
            if (!isIn(*block)) continue;
            if (own_) own_->beginBlock(*block);
            const bool isFirst =
                block == columns.begin || !follows(block[-1], *block) || !isIn(block[-1]);
            const bool isLast = block + 1 == columns.end || !follows(*block, block[1]);
            if (isFirst) {
                before_ = {};
                held_ = {};
                if (own_) own_->beginColumn();
            }
            if (tools_.mixer) {
                addMixed(*block);
            } else {
                read(*block);
                add(block->position, {0, 0}, layout_.slicesOf(block->position.x));
            }
            // What a block showed must be taken away behind it.
            const int next = firstPart(*block).x + parts_.slices;
            const int last = tools_.mixer ? layout_.lastBlock : range_.lastBlock;
            if (next > last || !isLast) continue;
            classes_.fill(kEmptySlot);
            forParts([&](const glm::ivec2& part) { add(partOf(*block, next, part), part, 1); });
        }
        own_.reset();
    }

    /// Of the parts of columns along u, one.
    PackedColumns& half(int i) { return halves_[std::size_t(i)]; }
    const SlabPlanner& planner() const { return planner_; }

  private:
    // Calls use(part) for the parts of a column along u and v.
    template <typename Use>
    void forParts(const Use& use) const {
        for (int u = 0; u < parts_.within; ++u)
            for (int v = 0; v < parts_.within; ++v) use(glm::ivec2(u, v));
    }
    static std::size_t numberOf(const glm::ivec2& part) {
        const int number = 2 * part.x + part.y;
        return std::size_t(number);
    }

    // The positions of a block's first part, and of another.
    glm::ivec3 firstPart(const CodeBlock& block) const {
        return (block.position - parts_.origin / 8) *
               glm::ivec3(parts_.slices, parts_.within, parts_.within);
    }
    glm::ivec3 partOf(const CodeBlock& block, int slices, const glm::ivec2& part) const {
        const glm::ivec3 first = firstPart(block);
        return {slices, first.y + part.x, first.z + part.y};
    }

    void read(const CodeBlock& block) {
        if (!tools_.holder) {
            if (block.slots) {
                for (std::size_t i = 0; i < classes_.size(); ++i)
                    classes_[i] = ClassIndex(slotMap_[block.slots[i]]);
            } else if (!block.leaf) {
                classes_.fill(ClassIndex(block.tileSlot));
            } else {
                readLeafSlices(*block.leaf, options_.sliceAxis, mapped(slotMap_), classes_.data());
            }
            if (own_) own_->paint(block.position, 0, classes_);
            return;
        }
        if (block.slots) {
            for (std::size_t i = 0; i < slots_.size(); ++i) slots_[i] = slotMap_[block.slots[i]];
        } else if (block.leaf) {
            readLeafSlices(*block.leaf, options_.sliceAxis, mapped(slotMap_), slots_.data());
        } else {
            slots_.fill(block.tileSlot);
        }
        hold(slots_, block.position, {0, 0}, 0);
    }

    // @param part    of the column: what was before is kept for each
    // @param number  of what the block in hand becomes
    void hold(const BlockSlots& slots, const glm::ivec3& position, const glm::ivec2& part,
              int number) {
        HeldSlots& held = held_[numberOf(part)];
        if (own_) return holdLooks(slots, position, number, held, own_->held(numberOf(part)));
        const SlotHolder& holder = *tools_.holder;
        const auto next = [&](Slot before, Slot slot) { return holder.next(before, slot); };
        holdSlots(slots, held, next,
                  [&](std::size_t i, Slot slot) { classes_[i] = holder.classOf(slot); });
    }

    // What is held is slot and look together, each of which has to allow it.
    [[gnu::noinline]] void holdLooks(const BlockSlots& slots, const glm::ivec3& position,
                                     int number, HeldSlots& before,
                                     BlockLooks::Slice& looksBefore) {
        const SlotHolder& holder = *tools_.holder;
        for (std::size_t i = 0; i < slots.size(); ++i) classes_[i] = holder.classOf(slots[i]);
        own_->paint(position, number, classes_);
        for (std::size_t i = 0; i < slots.size(); ++i) {
            Slot& held = before[i & 63];
            OwnLook& heldOwn = looksBefore[i & 63];
            const VoxelLook look{classes_[i], own_->block()[i]};
            const VoxelLook heldLook{holder.classOf(held), heldOwn};
            const bool keeps = !(heldLook == look) && holder.allows(held, slots[i]) &&
                               options_.looksHold(heldLook, look);
            if (!keeps) {
                held = slots[i];
                heldOwn = look.own;
            }
            classes_[i] = holder.classOf(held);
            own_->block()[i] = heldOwn;
        }
    }

    void addMixed(const CodeBlock& block) {
        inHand_ = &block;
        window_->reader.read(block, window_->window);
        if (uncut_) uncut_->reader.read(block.position, uncut_->window);
        const bool isSeen = tools_.sight->canBeSeen(window_->window);
        const bool isPainted = choosesClasses(options_);
        if (isSeen && !isPainted) tools_.mixer->mix(window_->window, slotMap_, mixed_);
        for (int s = 0; s < parts_.slices; ++s) {
            forParts([&](const glm::ivec2& part) {
                const glm::ivec3 position = partOf(block, firstPart(block).x + s, part);
                const int slices = layout_.slicesOf(position.x);
                // The box may begin and end within a block: some of what it becomes lies outside.
                if (position.x < layout_.firstBlock || slices <= 0) return;
                const int number = (part.x * parts_.slices + s) * parts_.within + part.y;
                const BlockSlots& slots = mixed_[std::size_t(number)];
                if (!isSeen) {
                    classes_.fill(kEmptySlot);
                    held_[numberOf(part)].fill(kEmptySlot);
                } else if (isPainted) {
                    own_->paint(position, number, classes_);
                    if (uncut_) clearCutOff(position);
                } else if (tools_.holder) {
                    hold(slots, position, part, number);
                } else {
                    std::copy(slots.begin(), slots.end(), classes_.begin());
                    if (own_) own_->paint(position, number, classes_);
                }
                add(position, part, slices);
            });
        }
    }

    // Clears what was painted by values that were cut off: voxels that are not active any more, or
    // never were and have nothing left beside them.
    void clearCutOff(const glm::ivec3& position) {
        const glm::ivec3 per(parts_.slices, parts_.within, parts_.within);
        const glm::ivec3 first = 8 * (position - firstPart(*inHand_));
        for (int n = 0; n < 512; ++n) {
            if (classes_[std::size_t(n)] == 0) continue;
            const glm::ivec3 place = (first + glm::ivec3(n / 64, n / 8 % 8, n % 8)) / per;
            if (window_->window.at(place) != kEmptySlot) continue;
            if (uncut_->window.at(place) != kEmptySlot || !window_->window.hasAnyAround(place))
                classes_[std::size_t(n)] = 0;
        }
    }

    // Adds the words of the first `slices` slices of classes_.
    // @param part  of the column: what was before is kept for each
    void add(const glm::ivec3& position, const glm::ivec2& part, int slices) {
        SliceClasses& before = before_[numberOf(part)];
        PackedColumns& packed = halves_[std::size_t(part.x)];
        BlockChanges changes;
        compareClasses(before.data(), classes_.data(), changes.visible.data(),
                       changes.changed.data());
        if (own_) own_->compare(numberOf(part), changes);
        for (int s = 0; s < slices; ++s) {
            const std::uint64_t visible = changes.visible[s];
            const std::uint64_t changed = changes.changed[s];
            const int slice = 8 * position.x + s;
            const bool isKey = layout_.startsLaterSlab(slice);
            planner_.add(slice, visible, changed);
            const bool needed =
                (options_.encoding != Encoding::kWhole && changed != 0) ||
                ((options_.encoding != Encoding::kChanges || isKey) && visible != 0);
            if (!needed || !range_.storesWords) continue;
            packed.words.push_back(
                {visible, changed, packed.storage.size(), slice, {position.y, position.z}});
            packed.storage.insert(packed.storage.end(), &classes_[64 * s], &classes_[64 * s] + 64);
            if (!own_) continue;
            const OwnLook* looks = &own_->block()[64 * std::size_t(s)];
            packed.looks.insert(packed.looks.end(), looks, looks + 64);
        }
        std::copy_n(&classes_[7 * 64], 64, before.begin());
        if (own_) own_->endBlock(numberOf(part));
    }

    struct Window {
        Window(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly)
            : reader(codes, sliceAxis, alongSlicesOnly) {}
        MixWindowReader reader;
        MixWindow window;
    };

    const PackOptions& options_;
    PackTools tools_;
    std::span<const Slot> slotMap_;
    IndexBox box_;
    SlabPlanner planner_;
    PackRange range_;
    SlabLayout layout_;
    Subdivision parts_;
    BlockClasses classes_{};                // of the block in hand
    std::array<SliceClasses, 4> before_{};  // [part]: of the slice before it
    std::array<HeldSlots, 4> held_{};       // [part]
    BlockSlots slots_{};
    std::optional<Window> window_;
    std::optional<Window> uncut_;    // what was there before, if surfaces are cut
    std::vector<BlockSlots> mixed_;  // [part along u][along slices][along v]
    std::array<PackedColumns, 2> halves_;
    std::unique_ptr<BlockLooks> own_;  // null: classes say all
    const CodeBlock* inHand_ = nullptr;
};

// Cuts the blocks into runs of whole columns, for each of which there is one packer. The cuts
// depend on the volume alone.
// @param atRows  cut behind each row of columns as well
std::vector<Columns> cutAtColumns(const std::vector<CodeBlock>& blocks, bool atRows) {
    const std::ptrdiff_t least = std::max<std::ptrdiff_t>(128, std::ptrdiff_t(blocks.size()) / 256);
    std::vector<Columns> runs;
    const std::vector<std::size_t> columns = runBegins(blocks, shareColumn);
    const CodeBlock* begin = blocks.data();
    for (std::size_t i = 1; i < columns.size(); ++i) {
        const CodeBlock* const end = blocks.data() + columns[i];
        const bool isLast = columns[i] == blocks.size();
        const bool endsRow = isLast || end->position.y != end[-1].position.y;
        if (end - begin < least && !isLast && !(endsRow && atRows)) continue;
        runs.push_back({begin, end});
        begin = end;
    }
    return runs;
}

// Returns the packed columns ordered by u, then v: of a row of blocks that is halved along u, first
// all that lies before the middle.
std::vector<PackedColumns*> inOrder(const std::vector<Columns>& runs,
                                    std::vector<ColumnPacker>& packers, int halves) {
    std::vector<PackedColumns*> columns;
    for (std::size_t first = 0; first < runs.size();) {
        std::size_t last = first + 1;
        const auto row = [&](std::size_t i) { return runs[i].begin->position.y; };
        while (last < runs.size() && halves > 1 && row(last) == row(first)) ++last;
        for (int half = 0; half < halves; ++half)
            for (std::size_t i = first; i < last; ++i) columns.push_back(&packers[i].half(half));
        first = last;
    }
    return columns;
}

// Returns a volume's box in (slice, u, v) order, of the voxels that its own are divided into.
IndexBox boxOfSlices(const IndexBox& box, int sliceAxis, const Subdivision& parts) {
    const IndexBox own = permutedBox(box, sliceAxis);
    const glm::ivec3 per(parts.slices, parts.within, parts.within);
    return {(own.min - parts.origin) * per, (own.max - parts.origin) * per + per - 1};
}

// Returns the plan of all of a volume, also where only some of its slices are there.
// @param box  of the slices
SlabPlan planOf(const Volume& volume, const PackOptions& options, const IndexBox& box,
                const SlabPlanner& planner) {
    const SlotBlocks* const blocks = volume.codes->blocksAlong(options.sliceAxis);
    const SlabFacts* const facts = blocks ? blocks->facts() : nullptr;
    if (!facts) return planner.plan(options.encoding);
    SlabPlan plan{planner.shortest(), facts->slabs};
    const bool fits = facts->blocksPerSlab % plan.layout.blocksPerSlab == 0;
    plan.layout.blocksPerSlab = facts->blocksPerSlab;
    // They may come from anywhere.
    if (!fits || plan.layout.count() != int(plan.slabs.size())) {
        throw Error(ErrorCode::kInput,
                    gotExpected("facts of slabs", "those of another picture", "those of this one"));
    }
    for (int i = 0; i < plan.layout.count(); ++i)
        placeSlab(box, plan.layout, i, plan.slabs[std::size_t(i)]);
    return plan;
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

struct DeltaPacker::Impl {
    Impl(const Volume& ofVolume, const PackOptions& withOptions)
        : volume(ofVolume),
          options(withOptions),
          classOfSlot(withOptions.classOfSlot.begin(), withOptions.classOfSlot.end()) {
        const ValueMixer* mixer = options.mixer;
        if (mixer) divided = mixer->parts();
        box = boxOfSlices(volume.box, options.sliceAxis, divided);
        if (volume.empty()) return;
        options.classOfSlot = classOfSlot;
        if (options.holds) holder.emplace(mixer ? mixer->levels() : volume, options);
        slotMap = holder ? holder->numberOfSlot() : options.classOfSlot;
        if (mixer) sight.emplace(*mixer, slotMap, choosesClasses(options));
        blocks = sight ? sight->listBlocks(*volume.codes, options.sliceAxis, volume.histogram)
                       : listBlocks(*volume.codes, options.sliceAxis, slotMap);
        if (options.painter && options.painter->more())
            addBlocks(*options.painter->more(), options.sliceAxis, blocks);
        runs = cutAtColumns(blocks, divided.within > 1);
    }

    PackedDeltas noWords() const {
        PackedDeltas packed;
        packed.sliceAxis = options.sliceAxis;
        packed.box = box;
        return packed;
    }

    // All that there is, and slabs as short as they may be.
    PackRange wholeRange(const SlabPlanner& planner) const {
        const SlabLayout& layout = planner.shortest();
        return {layout, layout.firstBlock, layout.lastBlock};
    }

    std::vector<ColumnPacker> run(const PackRange& range) const {
        const PackTools tools{holder ? &*holder : nullptr, options.mixer, sight ? &*sight : nullptr,
                              volume.codes.get(),
                              volume.uncut ? volume.uncut.get() : volume.codes.get()};
        std::vector<ColumnPacker> packers;
        packers.reserve(runs.size());
        for (std::size_t i = 0; i < runs.size(); ++i)
            packers.emplace_back(box, options, tools, slotMap, range);
        parallelFor(packers.size(), [&](std::size_t i) { packers[i].run(runs[i]); });
        return packers;
    }

    void requireBlocks(double count) const {
        const double blockBytes = kBytesPerBlock + (options.painter ? kLookBytesPerBlock : 0);
        requireMemory(divided.divides() ? "delta grid of divided voxels (`between` 0: undivided)"
                                        : "delta grid",
                      count * divided.voxels() * blockBytes + 16.0 * box.dims().x);
    }

    const Volume& volume;
    PackOptions options;
    std::vector<Slot> classOfSlot;
    Subdivision divided;
    IndexBox box;
    std::optional<SlotHolder> holder;
    std::span<const Slot> slotMap;
    std::optional<MixedSight> sight;
    std::vector<CodeBlock> blocks;
    std::vector<Columns> runs;
    SlabPlan planned;
    std::vector<SlabRange> parts;
};

DeltaPacker::DeltaPacker(const Volume& volume, const PackOptions& options)
    : impl_(std::make_unique<Impl>(volume, options)) {}
DeltaPacker::~DeltaPacker() = default;
DeltaPacker::DeltaPacker(DeltaPacker&&) noexcept = default;

bool DeltaPacker::canBeParted() const {
    return !impl_->options.mixer && !impl_->options.painter && !impl_->holder;
}

double DeltaPacker::mostBytes() const {
    return double(impl_->blocks.size()) * kBytesPerBlock;
}

PackedDeltas DeltaPacker::packAll() {
    PackedDeltas packed = impl_->noWords();
    if (impl_->volume.empty()) return packed;
    impl_->requireBlocks(double(impl_->blocks.size()));
    SlabPlanner planner(packed.box);
    std::vector<ColumnPacker> packers = impl_->run(impl_->wholeRange(planner));
    for (const ColumnPacker& packer : packers) planner.add(packer.planner());
    SlabPlan plan = planOf(impl_->volume, impl_->options, packed.box, planner);
    packed.slabs = std::move(plan.slabs);
    collectWords(inOrder(impl_->runs, packers, impl_->divided.within), plan.layout,
                 impl_->options.painter != nullptr, packed);
    return packed;
}

PackedDeltas DeltaPacker::plan(double mostBytes) {
    PackedDeltas packed = impl_->noWords();
    if (impl_->volume.empty()) return packed;
    SlabPlanner planner(packed.box);
    PackRange range = impl_->wholeRange(planner);
    range.storesWords = false;
    for (const ColumnPacker& packer : impl_->run(range)) planner.add(packer.planner());
    impl_->planned = planOf(impl_->volume, impl_->options, packed.box, planner);
    packed.slabs = impl_->planned.slabs;
    packed.begins.assign(std::size_t(packed.box.dims().x) + 1, 0);
    double bytes = 0;
    for (int i = 0; i < int(packed.slabs.size()); ++i) {
        const double ofSlab = double(packed.slabs[std::size_t(i)].stampedWords()) * kBytesPerWord;
        if (impl_->parts.empty() || bytes + ofSlab > mostBytes) {
            impl_->parts.push_back({i, i});
            bytes = 0;
        }
        impl_->parts.back().last = i + 1;
        bytes += ofSlab;
    }
    return packed;
}

const std::vector<SlabRange>& DeltaPacker::parts() const {
    return impl_->parts;
}

PackedDeltas DeltaPacker::pack(const SlabRange& part) const {
    PackedDeltas packed = impl_->noWords();
    packed.slabs = impl_->planned.slabs;
    const SlabLayout& layout = impl_->planned.layout;
    const int firstBlock = layout.firstBlock + part.first * layout.blocksPerSlab;
    const int lastBlock =
        std::min(layout.firstBlock + part.last * layout.blocksPerSlab - 1, layout.lastBlock);
    double words = 0;
    for (int i = part.first; i < part.last; ++i)
        words += double(packed.slabs[std::size_t(i)].stampedWords());
    requireMemory("part of a delta grid", words * kBytesPerWord);
    std::vector<ColumnPacker> packers = impl_->run({layout, firstBlock, lastBlock});
    collectWords(inOrder(impl_->runs, packers, 1), layout, false, packed);
    return packed;
}

PackedDeltas packDeltas(const Volume& volume, const PackOptions& options) {
    return DeltaPacker(volume, options).packAll();
}

}  // namespace deltasplat
