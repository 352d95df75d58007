// SPDX-License-Identifier: Apache-2.0
#include "words/slab_plan.h"

#include <algorithm>

#include "deltasplat/delta/stamp_counts.h"
#include "formats/delta/delta_grid.h"
#include "volume/block_kernels.h"
#include "volume/code_math.h"

namespace deltasplat {

namespace {

// Each slab costs a layer. The fewer slabs, the farther a strip's rows move along a sheet
// (src/composite/slab_renderer.cpp).
constexpr int kMostSlabs = 8;
constexpr int kLeastSlabs = 4;
constexpr int kShortSlab = 4;  // blocks of 8 slices: such short slabs may be fewer than kLeastSlabs
// Slabs are joined while key slices add a larger share of deltas.
constexpr double kMostKeyDeltas = 0.03;

// Time grows with words, not with changed voxels. Whole slabs need a tenth less, as nothing waits.
bool hasFewerWordsWhole(const PlannedSlab& slab) {
    return 9 * slab.seenWords < 10 * slab.words;
}

// Words with few changed voxels may be stamped, which is faster than summing. The threshold depends
// on the footprint (TileSplatter::leastStamps), unknown here; this is the smallest footprint's.
bool changesFew(const PlannedSlab& slab) {
    return slab.deltas < 12 * slab.words;
}

// @param writes  MaskCounts::writes of visible voxels and of changes
bool isWhole(const PlannedSlab& slab, const SliceCounts& writes, Encoding encoding) {
    switch (encoding) {
        case Encoding::kChanges:
            return false;
        case Encoding::kWhole:
            return true;
        case Encoding::kFewerWords:
            return hasFewerWordsWhole(slab);
        case Encoding::kFewerWordsOrVoxels:
            return hasFewerWordsWhole(slab) && 6 * slab.visible < 7 * slab.deltas;
        case Encoding::kFewerWordsOrWrites:
            return hasFewerWordsWhole(slab) && 3 * writes.visible < 4 * writes.deltas;
        case Encoding::kFewerWordsOrStamps:
            return changesFew(slab) ? 8 * slab.visible < 5 * slab.deltas : hasFewerWordsWhole(slab);
    }
    return false;
}

}  // namespace

SlabPlanner::SlabPlanner(const IndexBox& box) : box_(box), shortest_(layoutOf(box, 8)) {
    shortest_.blocksPerSlab = (shortest_.blocks() - 1) / kMostSlabs + 1;
    counts_.resize(shortest_.count());
}

void SlabPlanner::add(int slice, std::span<const std::uint64_t> visible,
                      std::span<const std::uint64_t> changed) {
    const auto count = [&](std::size_t slices) {
        const MaskCounts seen = countMasks(visible.first(slices));
        const MaskCounts differing = countMasks(changed.first(slices));
        return Counts{{seen.voxels, differing.voxels},
                      {seen.words, differing.words},
                      {seen.writes, differing.writes}};
    };
    SlabCounts& counts = counts_[shortest_.slabOf(slice >> 3)];
    counts.all += count(visible.size());
    if (shortest_.startsLaterSlab(slice)) counts.firstSlice += count(1);
}

void SlabPlanner::add(const SlabPlanner& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        counts_[i].all += other.counts_[i].all;
        counts_[i].firstSlice += other.counts_[i].firstSlice;
    }
}

SlabPlan SlabPlanner::plan(Encoding encoding, SlabLength slabLength) const {
    const int length = slabLength == SlabLength::kShortest ? 1 : chooseLength();
    SlabPlan plan{shortest_, {}};
    plan.layout.blocksPerSlab *= length;
    std::vector<Counts> counts;  // [slab]
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        const bool begins = i % length == 0;
        if (begins) counts.emplace_back();
        counts.back() += counts_[i].all;
        if (begins) counts.back().addKeySlice(counts_[i].firstSlice);
    }
    plan.slabs.resize(counts.size());
    for (int i = 0; i < plan.layout.count(); ++i) {
        PlannedSlab& slab = plan.slabs[std::size_t(i)];
        const auto& [voxels, words, writes] = counts[std::size_t(i)];
        placeSlab(box_, plan.layout, i, slab);
        slab.visible = voxels.visible;
        slab.deltas = voxels.deltas;
        slab.seenWords = words.visible;
        slab.words = words.deltas;
        slab.whole = isWhole(slab, writes, encoding);
    }
    return plan;
}

int SlabPlanner::chooseLength() const {
    const int longest = std::max(kShortSlab, (shortest_.blocks() - 1) / kLeastSlabs + 1);
    int length = 1;
    while (2 * length * shortest_.blocksPerSlab <= longest &&
           keyShare(std::size_t(length)) > kMostKeyDeltas) {
        length *= 2;
    }
    return length;
}

// Returns the share of deltas that key slices add if slabs are `length` times the shortest.
double SlabPlanner::keyShare(std::size_t length) const {
    double deltas = 0;
    double added = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        deltas += double(counts_[i].all.voxels.deltas);
        const SliceCounts& key = counts_[i].firstSlice.voxels;
        if (i % length == 0) added += double(key.visible) - double(key.deltas);
    }
    return deltas > 0 ? added / deltas : 0;
}

StampCounts predictStamps(const Volume& volume, int sliceAxis, std::span<const Slot> slotMap) {
    StampCounts stamps;
    if (volume.empty()) return stamps;
    stamps.traditional = voxelsOf(volume.box());
    const IndexBox box = permutedBox(volume.box(), sliceAxis);
    const SlabLayout layout = oneSlab(box);
    const BlockReader reader(*volume.codes(), nullptr, sliceAxis, slotMap);
    const BlockWindows windows(reader, layout);
    const std::vector<BlockChanges> changes = findChanges(windows, layout);
    SlabPlanner planner(box);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const int block = windows.position(i).x;
        const auto slices = std::size_t(layout.slicesOf(block));
        planner.add(8 * block, std::span(changes[i].visible).first(slices),
                    std::span(changes[i].changed).first(slices));
    }
    for (const PlannedSlab& slab : planner.plan(Encoding::kFewerWordsOrWrites).slabs) {
        stamps.sparse += slab.visible;
        stamps.delta += slab.deltas;
        stamps.automatic += slab.stamps();
    }
    return stamps;
}

std::vector<Slot> slotsWithout(const CodeBook& codeBook, double value) {
    std::vector<Slot> slotMap(kSlotCount, kEmptySlot);
    for (int code = 0; code < kCodeCount; ++code) {
        if (!codeBook.standsFor(Code(code), value)) slotMap[code + 1] = code + 1;
    }
    return slotMap;
}

}  // namespace deltasplat
