// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 6, read backwards: a slice is the sum of all changes since the last key slice.
#include "formats/delta/column_decoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "base/affine.h"
#include "base/memory.h"
#include "formats/delta/delta_format.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

BlockLayout::BlockLayout(const DeltaHeader& header)
    : first(toSliceOrder(header.box.min, header.sliceAxis)),
      last(toSliceOrder(header.box.max, header.sliceAxis)),
      firstBlock(first >> 3),
      lastBlock(last >> 3),
      blocksPerSlab(header.keyInterval / 8) {}

glm::ivec2 BlockLayout::blocksOf(int slab) const {
    const int begin = firstBlock.x + slab * blocksPerSlab;
    return {begin, std::min(begin + blocksPerSlab - 1, lastBlock.x)};
}

double BlockLayout::columns() const {
    const glm::dvec3 blocks = lastBlock - firstBlock + 1;
    return blocks.y * blocks.z;
}

bool BlockLayout::hasColumn(const glm::ivec2& place) const {
    return glm::all(glm::greaterThanEqual(place, glm::ivec2(firstBlock.y, firstBlock.z))) &&
           glm::all(glm::lessThanEqual(place, glm::ivec2(lastBlock.y, lastBlock.z)));
}

std::uint64_t BlockLayout::insideOf(const glm::ivec2& place) const {
    std::uint64_t mask = 0;
    for (int n = 0; n < 64; ++n) {
        const int u = 8 * place.x + (n >> 3), v = 8 * place.y + (n & 7);
        if (u >= first.y && u <= last.y && v >= first.z && v <= last.z)
            mask |= std::uint64_t{1} << n;
    }
    return mask;
}

bool BlockLayout::canListRest(std::size_t changed) const {
    const double slices = lastBlock.x - firstBlock.x + 1;
    return slices * columns() <= 16.0 * double(changed) + 65536;
}

SlotRules slotRulesOf(const DeltaHeader& header) {
    SlotRules rules;
    rules.lowest = 1;
    rules.highest = std::uint32_t(header.codeCount);
    if (header.book.kind == CodeBook::Kind::kHalf) {
        // Codes follow the order of values, so the finite ones are neighbours.
        const auto isFinite = [&](std::uint32_t slot) {
            return std::isfinite(header.book.valueOf(Code(slot - 1)));
        };
        while (rules.lowest <= rules.highest && !isFinite(rules.lowest)) ++rules.lowest;
        while (rules.lowest <= rules.highest && !isFinite(rules.highest)) --rules.highest;
    }
    rules.firstInactive = std::uint32_t(kSlotCount);
    rules.inactiveCount = std::uint32_t(header.inactiveValues.size());
    if (header.restActive) rules.rest = ShortSlot(header.book.codeOf(header.background) + 1);
    return rules;
}

CodeRange rangeOf(std::span<const SlotBlock> blocks) {
    CodeRange range;
    for (const SlotBlock& block : blocks)
        range = rangeOfBoth(range, std::pair(block.lowest, block.highest));
    return range;
}

CodeRange rangeOfBoth(const CodeRange& a, const CodeRange& b) {
    if (!a || !b) return a ? a : b;
    return std::pair(std::min(a->first, b->first), std::max(a->second, b->second));
}

std::vector<std::uint64_t> takeHistogram(CodeCounts& slots) {
    std::vector<std::uint64_t> histogram = slots.take();
    histogram.erase(histogram.begin());
    histogram.push_back(0);
    return histogram;
}

ColumnDecoder::ColumnDecoder(std::unique_ptr<DeltaWalker> walker, const Grid& grid,
                             CodeCounts* counts, std::size_t worker)
    : walker_(std::move(walker)),
      grid_(grid),
      counts_(counts),
      worker_(worker),
      slabDeltas_(std::size_t(grid.layout.slabs())) {}

bool ColumnDecoder::decode(const DeltaColumn& column, const glm::ivec2& range,
                           std::vector<SlotBlock>& blocks) {
    slots_.fill(0);
    leftOut_.reset();
    inside_ = grid_.layout.insideOf(column.place);
    if (!walker_->start(column) || walker_->block() < range.x) return false;
    bool isZero = true;
    for (int block = range.x; block <= range.y; ++block) {
        if (grid_.layout.startsSlab(block) && !isZero) {
            slots_.fill(0);
            isZero = true;
        }
        const int next = walker_->block();
        const bool changes = next == block;
        if (!changes && isZero && !grid_.header.restActive) {
            if (next > range.y) break;
            block = next - 1;
            continue;
        }
        const glm::ivec3 position(block, column.place);
        if (!changes) {
            int end = std::min(next, range.y + 1);
            if (!isZero) end = std::min(end, grid_.layout.endOfSlab(block));
            if (!decodeAlike(position, end, blocks)) return false;
            block = end - 1;
            continue;
        }
        const BlockDeltas* const deltas = walker_->take();
        if (!deltas || !decodeBlock(position, deltas, blocks)) return false;
        isZero = isConstant() && slots_[0] == 0;
    }
    return walker_->block() == DeltaWalker::kNoBlock;
}

// Adds the blocks without deltas up to `end`, each of which shows the same as the one before. If
// the first is left out, all are skipped in one step.
bool ColumnDecoder::decodeAlike(glm::ivec3 position, int end, std::vector<SlotBlock>& blocks) {
    const BlockLayout& layout = grid_.layout;
    while (position.x < end) {
        const std::size_t before = blocks.size();
        const std::uint64_t activeBefore = activeCount_;
        if (!decodeBlock(position, nullptr, blocks)) return false;
        const bool isWhole = layout.hasSlice(8 * position.x) && layout.hasSlice(8 * position.x + 7);
        ++position.x;
        if (blocks.size() > before || !isWhole) continue;
        // The last block may lack slices.
        const int alike = std::max(end - 1 - position.x, 0);
        activeCount_ += std::uint64_t(alike) * (activeCount_ - activeBefore);
        if (activeCount_ > grid_.header.active) return false;
        position.x += alike;
    }
    return true;
}

bool ColumnDecoder::decodeBlock(const glm::ivec3& position, const BlockDeltas* deltas,
                                std::vector<SlotBlock>& blocks) {
    const BlockLayout& layout = grid_.layout;
    const bool isWhole = inside_ == ~std::uint64_t{0} && layout.hasSlice(8 * position.x) &&
                         layout.hasSlice(8 * position.x + 7);
    if (!deltas && isWhole && isConstant()) {
        const ShortSlot slot = shown(slots_[0]);
        if (slot == 0) return true;
        return addTile(position, slot, blocks);
    }
    ShortSlot* out = room();
    if (deltas) {
        if (!addBlock(position, *deltas, out)) return false;
    } else {
        for (int s = 0; s < 8; ++s)
            if (!writeSlice(position, s, out + 64 * s)) return false;
    }
    const SlotRange range = rangeOf(out);
    if (range.highest == 0) return true;
    const auto tile = ShortSlot(range.highest);
    if (range.lowest == range.highest && !range.hasEmpty) {
        return addTile(position, tile, blocks);
    }
    if (counts_) {
        counts_->add(worker_, std::span<const ShortSlot>(out, 512),
                     range.hasEmpty ? kEmptySlot : range.lowest, range.highest);
        extend(position, out);
    }
    const auto empty = range.hasEmpty ? std::count(out, out + 512, ShortSlot{0}) : 0;
    const SlotBlock block{position, out, kEmptySlot, Code(range.lowest - 1),
                          Code(range.highest - 1)};
    const std::size_t before = blocks.size();
    const bool isSound = add(block, std::uint64_t(512 - empty), blocks);
    // A block that was left out gives its room to the next one.
    used_ += blocks.size() - before;
    return isSound;
}

bool ColumnDecoder::isConstant() const {
    return std::all_of(slots_.begin(), slots_.end(),
                       [&](std::uint32_t slot) { return slot == slots_[0]; });
}

// Returns what a block shows of a slot: a code or the resting value.
ShortSlot ColumnDecoder::shown(std::uint32_t slot) const {
    if (slot == 0) return grid_.rules.rest;
    return slot < grid_.rules.firstInactive ? ShortSlot(slot) : ShortSlot{0};
}

bool ColumnDecoder::addBlock(const glm::ivec3& position, const BlockDeltas& deltas,
                             ShortSlot* out) {
    std::uint64_t& count = slabDeltas_[std::size_t(grid_.layout.slabOf(position.x))];
    const std::int32_t* next = deltas.numbers;
    for (int s = 0; s < 8; ++s) {
        const std::uint64_t changed = deltas.changed[std::size_t(s)];
        if (changed != 0 &&
            ((changed & ~inside_) != 0 || !grid_.layout.hasSlice(8 * position.x + s)))
            return false;
        const std::uint64_t given = deltas.given[std::size_t(s)];
        addDeltas(given, next, slots_.data());
        next += std::popcount(given);
        count += std::uint64_t(std::popcount(changed));
        if (!writeSlice(position, s, out + 64 * s)) return false;
    }
    return true;
}

// Writes the shown values of a slice, or zeros behind the last slice. Returns whether it is sound.
bool ColumnDecoder::writeSlice(const glm::ivec3& position, int s, ShortSlot* out) const {
    if (!grid_.layout.hasSlice(8 * position.x + s)) {
        std::fill_n(out, 64, ShortSlot{0});
        return true;
    }
    if (!shortenSlots(slots_.data(), grid_.rules, out)) return false;
    for (std::uint64_t outside = ~inside_; outside != 0; outside &= outside - 1)
        out[std::countr_zero(outside)] = 0;
    return true;
}

ShortSlot* ColumnDecoder::room() {
    if (storage_.empty() || used_ == kChunk) {
        constexpr std::size_t kBytes = kChunk * 512 * sizeof(ShortSlot);
        requireMemory(grid_.where, double(kBytes));
        expectPieces(kBytes);
        storage_.push_back(std::make_unique_for_overwrite<ShortSlot[]>(kChunk * 512));
        used_ = 0;
    }
    return storage_.back().get() + 512 * used_;
}

bool ColumnDecoder::addTile(const glm::ivec3& position, ShortSlot slot,
                            std::vector<SlotBlock>& blocks) {
    if (counts_) {
        counts_->add(worker_, slot, 512);
        include(position, glm::ivec3(0), glm::ivec3(7));
    }
    return add({position, nullptr, slot, Code(slot - 1), Code(slot - 1)}, 512, blocks);
}

// Adds a block unless it is left out. One delta can stand for all blocks until the next key slice,
// so decoding stops as soon as the header's voxel count is exceeded.
bool ColumnDecoder::add(const SlotBlock& block, std::uint64_t active,
                        std::vector<SlotBlock>& blocks) {
    constexpr std::size_t kAskEvery = 1024;
    if (!grid_.seen || grid_.seen->hasAny(block.lowest, block.highest)) {
        if (blocks.size() % kAskEvery == 0)
            requireMemory(grid_.where, 2.0 * kAskEvery * sizeof(SlotBlock));
        blocks.push_back(block);
    } else {
        leftOut_ = rangeOfBoth(leftOut_, std::pair(block.lowest, block.highest));
    }
    activeCount_ += active;
    return activeCount_ <= grid_.header.active;
}

void ColumnDecoder::extend(const glm::ivec3& position, const ShortSlot* out) {
    if (grid_.header.restActive || contains(position)) return;
    glm::ivec3 low(7), high(0);
    for (int n = 0; n < 512; ++n) {
        if (out[n] == 0) continue;
        const glm::ivec3 place(n >> 6, n >> 3 & 7, n & 7);
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    include(position, low, high);
}

bool ColumnDecoder::contains(const glm::ivec3& position) const {
    return !active_.empty() && glm::all(glm::lessThanEqual(active_.min, 8 * position)) &&
           glm::all(glm::greaterThanEqual(active_.max, 8 * position + 7));
}

void ColumnDecoder::include(const glm::ivec3& position, const glm::ivec3& low,
                            const glm::ivec3& high) {
    active_ = boxOfBoth(active_, {8 * position + low, 8 * position + high});
}

}  // namespace deltasplat
