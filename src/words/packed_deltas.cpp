// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 9. Deviates in that a change stores only the new class, because a walk in order knows
// the old one.
#include "words/packed_deltas.h"

#include <algorithm>
#include <glm/common.hpp>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "base/bits.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "deltasplat/error.h"
#include "words/class_reader.h"
#include "words/joined_tiles.h"
#include "words/pack_columns.h"
#include "words/slice_joiner.h"
#include "words/value_mixer.h"

namespace deltasplat {
namespace {

// Adds blocks, in order, in which only the painter shows something.
// @param box  of the volume, which may be one of the painter's groups
void addBlocks(const BlockSet& more, const IndexBox& box, int sliceAxis,
               std::vector<CodeBlock>& blocks) {
    const auto isInBox = [&](const glm::ivec3& position) {
        const glm::ivec3 first = 8 * position;
        return first == glm::clamp(first, box.min - 7, box.max);
    };
    std::vector<CodeBlock> added;
    for (const glm::ivec3& position : more.positions)
        if (isInBox(position)) added.push_back({toSliceOrder(position, sliceAxis)});
    std::sort(added.begin(), added.end(), comesBefore);
    std::vector<CodeBlock> all;
    std::set_union(blocks.begin(), blocks.end(), added.begin(), added.end(),
                   std::back_inserter(all), comesBefore);
    blocks = std::move(all);
}

// Cuts blocks into runs of whole columns, one per writer. The cuts depend on the volume only.
// @param atRows  also cut behind each row of columns
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

// Reusable memory for unsorted words: new memory takes longer than making the words.
class WordRooms {
  public:
    std::vector<PackedColumns> take() {
        const std::lock_guard lock(mutex_);
        if (rooms_.empty()) return {};
        std::vector<PackedColumns> room = std::move(rooms_.back());
        rooms_.pop_back();
        return room;
    }
    void give(std::vector<PackedColumns> room) {
        const std::lock_guard lock(mutex_);
        rooms_.push_back(std::move(room));
    }

  private:
    std::mutex mutex_;
    std::vector<std::vector<PackedColumns>> rooms_;
};

// Returns the packed columns ordered by u, then v.
// @param rowOf  rowOf(i): row of writer i's columns; several rows if blocks are halved or joined
template <typename RowOf>
std::vector<PackedColumns*> inOrder(std::vector<WordWriter>& writers, const RowOf& rowOf) {
    std::vector<PackedColumns*> columns;
    for (std::size_t first = 0; first < writers.size();) {
        std::size_t last = first + 1;
        while (last < writers.size() && rowOf(last) == rowOf(first)) ++last;
        for (std::size_t row = 0; row < writers[first].rows().size(); ++row)
            for (std::size_t i = first; i < last; ++i) columns.push_back(&writers[i].rows()[row]);
        first = last;
    }
    return columns;
}

}  // namespace

IndexBox boxOfSlices(const IndexBox& box, int sliceAxis, const Subdivision& parts) {
    const IndexBox own = permutedBox(box, sliceAxis);
    if (parts.joined > 1) {
        IndexBox joined = own;
        for (const glm::ivec2& slant : parts.joinedSlants()) {
            joined.min = glm::min(joined.min, own.min + glm::ivec3(0, slant));
            joined.max = glm::max(joined.max, own.max + glm::ivec3(0, slant));
        }
        const glm::ivec3 of(parts.joined, parts.joinedWithin, parts.joinedWithin);
        for (int axis = 0; axis < 3; ++axis) {
            joined.min[axis] = floorDiv(joined.min[axis], of[axis]);
            joined.max[axis] = floorDiv(joined.max[axis], of[axis]);
        }
        return joined;
    }
    const glm::ivec3 per(parts.slices, parts.within, parts.within);
    return {(own.min - parts.origin) * per, (own.max - parts.origin) * per + per - 1};
}

std::uint64_t PackedDeltas::visible() const {
    return sumOf(slabs, &Slab::visible);
}

std::uint64_t PackedDeltas::deltas() const {
    return sumOf(slabs, &Slab::deltas);
}

bool PackedDeltas::areWhole() const {
    return std::all_of(slabs.begin(), slabs.end(),
                       [](const PlannedSlab& slab) { return slab.whole; });
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
        if (options.joiner) {
            joiner = *options.joiner;
            options.joiner = &*joiner;
            divided.joined = int(options.slants.size());
            divided.joinedWithin = options.joinedWithin;
            std::copy(options.slants.begin(), options.slants.end(), divided.slants.begin());
            options.slants = divided.joinedSlants();  // the caller's slants may be gone
        }
        box = boxOfSlices(volume.box(), options.sliceAxis, divided);
        if (volume.empty()) return;
        options.classOfSlot = classOfSlot;
        if (options.holds) holder.emplace(mixer ? mixer->levels() : volume, options);
        slotMap = holder ? holder->numberOfSlot() : options.classOfSlot;
        if (mixer) mixMap.emplace(slotMap, opacitiesOfMapped());
        options.opacities = {};
        if (mixer) sight.emplace(*mixer, slotMap, choosesClasses(options));
        const SeenCone* const seen = options.seen ? &*options.seen : nullptr;
        // Mixing lists blocks together with their neighbours.
        blocks = sight ? sight->listBlocks(*volume.codes(), options.sliceAxis, volume.histogram())
                       : listBlocks(*volume.codes(), options.sliceAxis, slotMap, seen);
        if (options.painter && options.painter->more())
            addBlocks(*options.painter->more(), volume.box(), options.sliceAxis, blocks);
        if (seen && (sight || options.painter)) {
            std::erase_if(blocks,
                          [&](const CodeBlock& block) { return !seen->sees(block.position); });
        }
        if (joiner) {
            joined.emplace(blocks, options.slants, options.joinedWithin);
        } else {
            runs = cutAtColumns(blocks, divided.within > 1);
        }
        if (!holder && !mixer) findRamps();
    }

    void findRamps() {
        Code lowest = std::numeric_limits<Code>::max();
        Code highest = 0;
        for (const CodeBlock& block : blocks) {
            if (!block.leaf && !block.slots) continue;
            lowest = std::min(lowest, block.lowest);
            highest = std::max(highest, block.highest);
        }
        if (lowest <= highest) ramps.emplace(slotMap, lowest, highest);
    }

    // Returns the opacities of mapped slots; none if unknown.
    std::vector<float> opacitiesOfMapped() const {
        if (options.opacities.empty()) return {};
        const Slot last = *std::max_element(slotMap.begin(), slotMap.end());
        std::vector<float> opacities(std::size_t(last) + 1);
        for (std::size_t slot = 0; slot < slotMap.size(); ++slot)
            opacities[std::size_t(slotMap[slot])] =
                options.opacities[std::size_t(classOfSlot[slot])];
        return opacities;
    }

    PackedDeltas noWords() const {
        PackedDeltas packed;
        packed.sliceAxis = options.sliceAxis;
        packed.descending = options.descending;
        packed.box = box;
        return packed;
    }

    // All blocks, with the shortest slabs.
    PackRange wholeRange(const SlabPlanner& planner) const {
        const SlabLayout& layout = planner.shortest();
        return {layout, layout.firstBlock, layout.lastBlock};
    }

    std::vector<WordWriter> run(const PackRange& range) const {
        const SourceTools tools{options,
                                slotMap,
                                box,
                                ramps ? &*ramps : nullptr,
                                holder ? &*holder : nullptr,
                                sight ? &*sight : nullptr,
                                volume.codes().get(),
                                volume.uncut() ? volume.uncut().get() : volume.codes().get(),
                                mixMap ? &*mixMap : nullptr};
        const ClassReader classes(slotMap, tools.ramps, options.sliceAxis);
        const std::size_t count = joined ? joined->runs().size() : runs.size();
        // A column has up to four parts.
        const std::size_t columns = joined ? JoinedTileReader::kColumns : 4;
        std::vector<WordWriter> writers(count, WordWriter(box, options, range, columns));
        WordRooms rooms;
        const auto pack = [&](std::size_t i) {
            std::vector<PackedColumns> room = rooms.take();
            if (joined) {
                packTiles(*joined, i, classes, *joiner, options.descending, writers[i], room);
            } else {
                packColumns(runs[i], *makeSource(tools), writers[i], room);
            }
            rooms.give(std::move(room));
        };
        const bool areLooks = joiner && joiner->looks();
        if (!range.budget && !areLooks) {
            parallelFor(count, pack);
            return writers;
        }
        // A sample predicts words and looks. The rest is in order, because neighbours share leaves.
        constexpr std::size_t kStep = 16;
        const std::size_t sample = (count + kStep - 1) / kStep;
        if (areLooks && sample < count) joiner->looks()->beginSample();
        // The sample's even runs first, then its odd ones.
        parallelFor((sample + 1) / 2, [&](std::size_t i) { pack(kStep * 2 * i); });
        const std::size_t ofHalf = areLooks ? joiner->looks()->count() : 0;
        parallelFor(sample / 2, [&](std::size_t i) { pack(kStep * (2 * i + 1)); });
        if (range.budget) range.budget->foresee(double(sample) / double(count));
        if (areLooks) {
            joiner->looks()->endSample(ofHalf);
            if (hasTooManyLooks()) return writers;
        }
        parallelFor(count, [&](std::size_t i) {
            if (i % kStep != 0) pack(i);
        });
        return writers;
    }

    bool hasTooManyLooks() const { return joiner && joiner->hasTooManyLooks(); }

    // Whether there were too many looks, so that slices must be joined again with coarser looks.
    bool mustJoinAgain() {
        if (!hasTooManyLooks()) return false;
        if (joiner->looks()->run().bits == LookRun::kLeastBits)
            throw std::logic_error("looks of few levels without numbers");
        joiner->looks() = joiner->looks()->coarser();
        return true;
    }

    // Plans slabs from the writers' counts, and collects their words.
    void collect(std::vector<WordWriter>& writers, SlabPlanner& planner,
                 PackedDeltas& packed) const {
        for (const WordWriter& writer : writers) planner.add(writer.planner());
        SlabPlan plan = planner.plan(options.encoding, options.slabLength);
        packed.slabs = std::move(plan.slabs);
        collectWords(columnsOf(writers), plan.layout, options.painter != nullptr, packed);
    }

    std::vector<PackedColumns*> columnsOf(std::vector<WordWriter>& writers) const {
        // Writers with one row of columns each are in order.
        return inOrder(writers, [&](std::size_t i) {
            if (joined) return joined->runs()[i].front().x;
            return divided.within > 1 ? runs[i].begin->position.y : int(i);
        });
    }

    double mostBlocks() const {
        return joined ? double(joined->mostBlocks()) : double(blocks.size()) * divided.voxels();
    }

    double mostBytes() const { return mostBlocks() * kMostWordsOfBlock * kBytesPerWord; }

    // Words to store before they are counted. None if `bytes` is less than an eighth of the upper
    // bound, because words rarely take less.
    double wordsToTry(double bytes) const {
        if (mostBytes() > 8 * bytes) return 0;
        return std::min(bytes, double(availableMemory()) / 2) / kBytesPerWord;
    }

    void requireBlocks() const {
        const double wordBytes = kBytesPerWord + (options.painter ? kLookBytesPerWord : 0);
        requireMemory(divided.divides() ? "delta grid of divided voxels (`between` 0: undivided)"
                                        : "delta grid",
                      mostBlocks() * kMostWordsOfBlock * wordBytes + 16.0 * box.dims().x);
    }

    // Most words of a slab in memory while it is packed (WordWriter::isNeeded).
    double storedWords(const PlannedSlab& slab) const {
        const bool storesAll = options.descending && !slab.whole;
        return double(storesAll ? slab.words + slab.seenWords : slab.stampedWords());
    }

    const Volume& volume;
    PackOptions options;
    std::vector<Slot> classOfSlot;
    std::optional<SliceJoiner> joiner;
    Subdivision divided;
    IndexBox box;
    std::optional<SlotHolder> holder;
    std::span<const Slot> slotMap;
    std::optional<ClassRamps> ramps;
    std::optional<MixMap> mixMap;
    std::optional<MixedSight> sight;
    std::vector<CodeBlock> blocks;
    std::vector<Columns> runs;
    std::optional<JoinedTiles> joined;  // replaces `runs` if slices are joined
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
    return impl_->mostBytes();
}

PackedDeltas DeltaPacker::packAll() {
    PackedDeltas packed = impl_->noWords();
    if (impl_->volume.empty()) return packed;
    impl_->requireBlocks();
    SlabPlanner planner(packed.box);
    std::vector<WordWriter> writers;
    do {
        writers = impl_->run(impl_->wholeRange(planner));
    } while (impl_->mustJoinAgain());
    impl_->collect(writers, planner, packed);
    return packed;
}

PackedDeltas DeltaPacker::packOrPlan(double mostBytes) {
    PackedDeltas packed = impl_->noWords();
    if (impl_->volume.empty()) return packed;
    SlabPlanner planner(packed.box);
    PackRange range = impl_->wholeRange(planner);
    std::optional<WordBudget> budget;
    std::vector<WordWriter> writers;
    do {
        budget.emplace(impl_->wordsToTry(mostBytes));
        range.storesWords = !budget->isSpent();
        range.budget = range.storesWords ? &*budget : nullptr;
        writers = impl_->run(range);
    } while (impl_->mustJoinAgain());
    if (!budget->isSpent()) {
        impl_->collect(writers, planner, packed);
        return packed;
    }
    for (const WordWriter& writer : writers) planner.add(writer.planner());
    impl_->planned = planner.plan(impl_->options.encoding, impl_->options.slabLength);
    packed.slabs = impl_->planned.slabs;
    packed.begins.assign(std::size_t(packed.box.dims().x) + 1, 0);
    double bytes = 0;
    for (int i = 0; i < int(packed.slabs.size()); ++i) {
        const double ofSlab = impl_->storedWords(packed.slabs[std::size_t(i)]) * kBytesPerWord;
        if (impl_->parts.empty() || bytes + ofSlab > mostBytes) {
            impl_->parts.push_back({i, i});
            bytes = 0;
        }
        impl_->parts.back().last = i + 1;
        bytes += ofSlab;
    }
    return packed;
}

const std::optional<SliceJoiner>& DeltaPacker::joiner() const {
    return impl_->joiner;
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
        words += impl_->storedWords(packed.slabs[std::size_t(i)]);
    requireMemory("part of a delta grid", words * kBytesPerWord);
    std::vector<WordWriter> writers =
        impl_->run({layout, firstBlock, lastBlock, true, impl_->planned.slabs});
    if (impl_->hasTooManyLooks()) throw std::logic_error("a part has looks that the whole has not");
    collectWords(impl_->columnsOf(writers), layout, false, packed);
    return packed;
}

PackedDeltas packDeltas(const Volume& volume, const PackOptions& options) {
    return DeltaPacker(volume, options).packAll();
}

}  // namespace deltasplat
