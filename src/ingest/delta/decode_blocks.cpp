// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// equation 6, read backwards: a slice is the sum of all changes since the last key slice.
#include "ingest/delta/decode_blocks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "deltasplat/threads.h"
#include "ingest/codes/code_counts.h"
#include "ingest/delta/leaf_kernels.h"
#include "memory.h"
#include "parallel.h"
#include "shared_progress.h"

namespace deltasplat {
namespace {

// What a grid's blocks have in common.
struct Layout {
    Layout(const DeltaHeader& header, const std::optional<glm::ivec2>& wanted)
        : first(toSliceOrder(header.box.min, header.sliceAxis)),
          last(toSliceOrder(header.box.max, header.sliceAxis)),
          firstBlock(first >> 3),
          lastBlock(last >> 3),
          blocksPerSlab(header.keyInterval / 8) {
        const int firstWanted = wanted ? std::max(wanted->x, firstBlock.x) : firstBlock.x;
        readFirst = firstBlock.x + slabOf(firstWanted) * blocksPerSlab;
        keptFirst = firstWanted;
        keptLast = wanted ? std::min(wanted->y, lastBlock.x) : lastBlock.x;
    }

    int slabOf(int block) const { return (block - firstBlock.x) / blocksPerSlab; }
    // Whether all of a slab is read.
    bool isRead(int slab) const {
        const int begin = firstBlock.x + slab * blocksPerSlab;
        return begin >= readFirst && std::min(begin + blocksPerSlab - 1, lastBlock.x) <= keptLast;
    }
    bool startsSlab(int block) const { return (block - firstBlock.x) % blocksPerSlab == 0; }
    int slabs() const { return slabOf(lastBlock.x) + 1; }
    double columns() const {
        const glm::dvec3 blocks = lastBlock - firstBlock + 1;
        return blocks.y * blocks.z;
    }
    bool hasColumn(const glm::ivec2& place) const {
        return glm::all(glm::greaterThanEqual(place, glm::ivec2(firstBlock.y, firstBlock.z))) &&
               glm::all(glm::lessThanEqual(place, glm::ivec2(lastBlock.y, lastBlock.z)));
    }
    // The voxels of a slice of a block that are in the box, as a mask word.
    std::uint64_t insideOf(const glm::ivec2& place) const {
        std::uint64_t mask = 0;
        for (int n = 0; n < 64; ++n) {
            const int u = 8 * place.x + (n >> 3), v = 8 * place.y + (n & 7);
            if (u >= first.y && u <= last.y && v >= first.z && v <= last.z)
                mask |= std::uint64_t{1} << n;
        }
        return mask;
    }
    bool isWhole() const { return keptFirst == firstBlock.x && keptLast == lastBlock.x; }
    bool hasSlice(int slice) const { return slice >= first.x && slice <= last.x; }

    glm::ivec3 first, last;  // voxels of the box, inclusive
    glm::ivec3 firstBlock, lastBlock;
    int blocksPerSlab;
    int readFirst;  // block of slices that reading begins with
    int keptFirst;  // of those that are kept
    int keptLast;
};

SlotRules rulesOf(const DeltaHeader& header) {
    SlotRules rules;
    rules.lowest = 1;
    rules.highest = std::uint32_t(header.codeCount);
    if (header.book.kind == CodeBook::Kind::kHalf) {
        // Codes are in the order of values, so that the finite ones are neighbours.
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

// What one thread makes of some columns.
class StripDecoder {
  public:
    StripDecoder(std::unique_ptr<DeltaWalker> walker, const DeltaHeader& header,
                 const Layout& layout, const SlotRules& rules, const std::string& where,
                 CodeCounts& counts, std::size_t worker)
        : walker_(std::move(walker)),
          header_(header),
          layout_(layout),
          where_(where),
          rules_(rules),
          counts_(counts),
          worker_(worker),
          slabDeltas_(std::size_t(layout.slabs())) {}

    // Adds the blocks of a column; returns whether it is sound.
    bool decode(const DeltaColumn& column, std::vector<SlotBlock>& blocks) {
        slots_.fill(0);
        inside_ = layout_.insideOf(column.place);
        if (!walker_->start(column) || walker_->block() < layout_.readFirst) return false;
        bool isZero = true;
        for (int block = layout_.readFirst; block <= layout_.keptLast; ++block) {
            if (layout_.startsSlab(block) && !isZero) {
                slots_.fill(0);
                isZero = true;
            }
            const int next = walker_->block();
            const bool changes = next == block;
            if (!changes && isZero && !header_.restActive) {
                if (next > layout_.keptLast) break;
                block = next - 1;
                continue;
            }
            const BlockDeltas* const deltas = changes ? walker_->take() : nullptr;
            if (changes && !deltas) return false;
            const glm::ivec3 position(block, column.place);
            if (!decodeBlock(position, deltas, blocks)) return false;
            isZero = changes ? isEmpty() : isZero;
        }
        return walker_->block() == DeltaWalker::kNoBlock || !layout_.isWhole();
    }

    std::span<const std::uint64_t> slabDeltas() const { return slabDeltas_; }
    const IndexBox& active() const { return active_; }
    std::vector<std::unique_ptr<ShortSlot[]>>& storage() { return storage_; }

  private:
    static constexpr std::size_t kChunk = 64;  // blocks whose slots are asked for at once

    bool isEmpty() const {
        return std::all_of(slots_.begin(), slots_.end(), [](std::uint32_t s) { return s == 0; });
    }

    bool decodeBlock(const glm::ivec3& position, const BlockDeltas* deltas,
                     std::vector<SlotBlock>& blocks) {
        const bool isWhole = inside_ == ~std::uint64_t{0} && layout_.hasSlice(8 * position.x) &&
                             layout_.hasSlice(8 * position.x + 7);
        if (!deltas && isWhole && isConstant()) {
            const ShortSlot slot = shown(slots_[0]);
            if (slot == 0 || position.x < layout_.keptFirst) return true;
            return addTile(position, slot, blocks);
        }
        ShortSlot* out = room();
        if (deltas) {
            if (!addBlock(position, *deltas, out)) return false;
        } else {
            for (int s = 0; s < 8; ++s)
                if (!writeSlice(position, s, out + 64 * s)) return false;
        }
        if (position.x < layout_.keptFirst) return true;
        const SlotRange range = rangeOf(out);
        if (range.highest == 0) return true;
        const auto tile = ShortSlot(range.highest);
        if (range.lowest == range.highest && !range.hasEmpty) {
            return addTile(position, tile, blocks);
        }
        counts_.add(worker_, std::span<const ShortSlot>(out, 512),
                    range.hasEmpty ? kEmptySlot : range.lowest, range.highest);
        extend(position, out);
        const auto empty = range.hasEmpty ? std::count(out, out + 512, ShortSlot{0}) : 0;
        ++used_;
        return add({position, out, kEmptySlot, Code(range.lowest - 1), Code(range.highest - 1)},
                   std::uint64_t(512 - empty), blocks);
    }

    bool isConstant() const {
        return std::all_of(slots_.begin(), slots_.end(),
                           [&](std::uint32_t slot) { return slot == slots_[0]; });
    }

    // What a block shows of a slot: a code, or what rests.
    ShortSlot shown(std::uint32_t slot) const {
        if (slot == 0) return rules_.rest;
        return slot < rules_.firstInactive ? ShortSlot(slot) : ShortSlot{0};
    }

    // Adds a block's deltas, slice by slice.
    bool addBlock(const glm::ivec3& position, const BlockDeltas& deltas, ShortSlot* out) {
        std::uint64_t& count = slabDeltas_[std::size_t(layout_.slabOf(position.x))];
        const std::int32_t* next = deltas.numbers;
        for (int s = 0; s < 8; ++s) {
            const std::uint64_t changed = deltas.changed[std::size_t(s)];
            if (changed != 0 &&
                ((changed & ~inside_) != 0 || !layout_.hasSlice(8 * position.x + s)))
                return false;
            const std::uint64_t given = deltas.given[std::size_t(s)];
            addDeltas(given, next, slots_.data());
            next += std::popcount(given);
            count += std::uint64_t(std::popcount(changed));
            if (!writeSlice(position, s, out + 64 * s)) return false;
        }
        return true;
    }

    // Writes what a slice of a block shows, behind the last slice nothing; returns whether it is
    // sound.
    bool writeSlice(const glm::ivec3& position, int s, ShortSlot* out) const {
        if (!layout_.hasSlice(8 * position.x + s)) {
            std::fill_n(out, 64, ShortSlot{0});
            return true;
        }
        if (!shortenSlots(slots_.data(), rules_, out)) return false;
        for (std::uint64_t outside = ~inside_; outside != 0; outside &= outside - 1)
            out[std::countr_zero(outside)] = 0;
        return true;
    }

    ShortSlot* room() {
        if (storage_.empty() || used_ == kChunk) {
            requireMemory(where_, kChunk * 512.0 * sizeof(ShortSlot));
            storage_.push_back(std::make_unique_for_overwrite<ShortSlot[]>(kChunk * 512));
            used_ = 0;
        }
        return storage_.back().get() + 512 * used_;
    }

    bool addTile(const glm::ivec3& position, ShortSlot slot, std::vector<SlotBlock>& blocks) {
        counts_.add(worker_, slot, 512);
        include(position, glm::ivec3(0), glm::ivec3(7));
        return add({position, nullptr, slot, Code(slot - 1), Code(slot - 1)}, 512, blocks);
    }

    // One delta can stand for as many blocks as there are slices until the next key slice: what is
    // more than the file says is not waited for.
    bool add(const SlotBlock& block, std::uint64_t active, std::vector<SlotBlock>& blocks) {
        constexpr std::size_t kAskEvery = 1024;
        if (blocks.size() % kAskEvery == 0)
            requireMemory(where_, 2.0 * kAskEvery * sizeof(SlotBlock));
        blocks.push_back(block);
        activeCount_ += active;
        return activeCount_ <= header_.active;
    }

    // Widens the box by a block's active voxels.
    void extend(const glm::ivec3& position, const ShortSlot* out) {
        if (header_.restActive || contains(position)) return;
        glm::ivec3 low(7), high(0);
        for (int n = 0; n < 512; ++n) {
            if (out[n] == 0) continue;
            const glm::ivec3 place(n >> 6, n >> 3 & 7, n & 7);
            low = glm::min(low, place);
            high = glm::max(high, place);
        }
        include(position, low, high);
    }
    bool contains(const glm::ivec3& position) const {
        return !active_.empty() && glm::all(glm::lessThanEqual(active_.min, 8 * position)) &&
               glm::all(glm::greaterThanEqual(active_.max, 8 * position + 7));
    }
    void include(const glm::ivec3& position, const glm::ivec3& low, const glm::ivec3& high) {
        const IndexBox box{8 * position + low, 8 * position + high};
        active_ = active_.empty()
                      ? box
                      : IndexBox{glm::min(active_.min, box.min), glm::max(active_.max, box.max)};
    }

    std::unique_ptr<DeltaWalker> walker_;
    const DeltaHeader& header_;
    const Layout& layout_;
    const std::string& where_;
    SlotRules rules_;
    CodeCounts& counts_;  // of slots
    std::size_t worker_;  // of them
    std::vector<std::uint64_t> slabDeltas_;
    IndexBox active_;  // in (slice, u, v) order
    std::uint64_t activeCount_ = 0;
    std::vector<std::unique_ptr<ShortSlot[]>> storage_;
    std::size_t used_ = 0;  // blocks of the last of it

    // Of the column in hand.
    std::array<std::uint32_t, 64> slots_{};
    std::uint64_t inside_ = 0;
};

// Returns all columns of the box, those without deltas too.
std::vector<DeltaColumn> allColumns(const std::vector<DeltaColumn>& columns, const Layout& layout) {
    std::vector<DeltaColumn> all;
    auto next = columns.begin();
    for (int u = layout.firstBlock.y; u <= layout.lastBlock.y; ++u) {
        for (int v = layout.firstBlock.z; v <= layout.lastBlock.z; ++v) {
            const bool isNext = next != columns.end() && next->place == glm::ivec2(u, v);
            all.push_back(isNext ? *next++ : DeltaColumn{{u, v}});
        }
    }
    return all;
}

// Of what rests active, all blocks of the box are listed.
bool canListRest(const Layout& layout, std::size_t changed) {
    const double slices = layout.keptLast - layout.readFirst + 1;
    return slices * layout.columns() <= 16.0 * double(changed) + 65536;
}

IndexBox inVolume(const IndexBox& box, int sliceAxis) {
    if (box.empty()) return {};
    return {fromSliceOrder(box.min, sliceAxis), fromSliceOrder(box.max, sliceAxis)};
}

// Puts together what the strips found; returns whether it is what the header says.
bool collect(std::vector<StripDecoder>& strips, CodeCounts& counts, const DeltaHeader& header,
             const Layout& layout, DecodedBlocks& decoded) {
    decoded.histogram = counts.take();
    // Of codes, not of slots.
    decoded.histogram.erase(decoded.histogram.begin());
    decoded.histogram.push_back(0);
    std::vector<std::uint64_t> slabDeltas(header.slabDeltas.size());
    IndexBox active;
    const std::uint64_t count =
        std::accumulate(decoded.histogram.begin(), decoded.histogram.end(), std::uint64_t{0});
    for (StripDecoder& strip : strips) {
        if (strip.slabDeltas().size() != slabDeltas.size()) return false;
        for (std::size_t i = 0; i < slabDeltas.size(); ++i) slabDeltas[i] += strip.slabDeltas()[i];
        if (!strip.active().empty()) {
            active = active.empty() ? strip.active()
                                    : IndexBox{glm::min(active.min, strip.active().min),
                                               glm::max(active.max, strip.active().max)};
        }
    }
    decoded.active = inVolume(active, header.sliceAxis);
    for (int slab = 0; slab < layout.slabs(); ++slab) {
        const auto i = std::size_t(slab);
        if (layout.isRead(slab) && slabDeltas[i] != header.slabDeltas[i]) return false;
    }
    return !layout.isWhole() || count == header.active;
}

}  // namespace

int slabStart(const DeltaHeader& header, int block) {
    return Layout(header, glm::ivec2(block)).readFirst;
}

bool mayDecodeBlocks(const DeltaHeader& header) {
    return !header.exact && header.hasZigzag() && header.codeCount < kCodeCount &&
           !header.box.empty() && (!header.restActive || header.inactiveValues.empty());
}

std::optional<DecodedBlocks> decodeBlocks(const DeltaColumns& deltas, const DeltaHeader& header,
                                          const std::string& where,
                                          const std::optional<glm::ivec2>& wanted,
                                          const Listener& listener) {
    const Layout layout(header, wanted);
    if (layout.keptFirst > layout.keptLast) return std::nullopt;
    if (header.slabDeltas.size() != std::size_t(layout.slabs())) return std::nullopt;
    if (header.restActive && std::uint64_t(header.box.voxels()) != header.active)
        return std::nullopt;
    if (header.restActive && !canListRest(layout, deltas.blocks())) return std::nullopt;
    const SlotRules rules = rulesOf(header);
    if (rules.lowest > rules.highest) return std::nullopt;
    for (const DeltaColumn& column : deltas.columns())
        if (!layout.hasColumn(column.place)) return std::nullopt;
    if (header.restActive) requireMemory(where, layout.columns() * sizeof(DeltaColumn));
    const std::vector<DeltaColumn> columns =
        header.restActive ? allColumns(deltas.columns(), layout) : deltas.columns();
    // Nearly all of them become blocks; how many more there are is seen on the way.
    requireMemory(where, double(deltas.blocks()) * 512 * sizeof(ShortSlot));

    // What a thread keeps is large: one for each, not for each piece of work.
    constexpr std::size_t kPiece = 8;  // columns
    const std::size_t pieces = (columns.size() + kPiece - 1) / kPiece;
    const std::size_t threads = std::min(std::size_t(std::max(1, threadCount())), pieces);
    CodeCounts counts(std::max<std::size_t>(1, threads));
    std::vector<StripDecoder> strips;
    strips.reserve(threads);
    for (std::size_t i = 0; i < threads; ++i)
        strips.emplace_back(deltas.walker(), header, layout, rules, where, counts, i);
    std::vector<std::vector<SlotBlock>> blocks(pieces);
    std::atomic<bool> isSound = true;
    std::atomic<std::size_t> next = 0;
    SharedProgress progress(listener);
    parallelFor(threads, [&](std::size_t strip) {
        for (std::size_t piece = next++; piece < pieces && isSound; piece = next++) {
            const std::size_t end = std::min(columns.size(), (piece + 1) * kPiece);
            for (std::size_t i = piece * kPiece; i < end; ++i) {
                if (!strips[strip].decode(columns[i], blocks[piece])) isSound = false;
            }
            progress.report(double(piece) / double(pieces));
        }
    });
    DecodedBlocks decoded;
    if (!isSound || !collect(strips, counts, header, layout, decoded)) return std::nullopt;
    std::size_t count = 0;
    for (const auto& some : blocks) count += some.size();
    requireMemory(where, double(count) * sizeof(SlotBlock));
    std::vector<SlotBlock> all;
    all.reserve(count);
    for (const auto& some : blocks) all.insert(all.end(), some.begin(), some.end());
    std::vector<std::unique_ptr<ShortSlot[]>> storage;
    for (StripDecoder& strip : strips)
        std::move(strip.storage().begin(), strip.storage().end(), std::back_inserter(storage));
    decoded.blocks =
        std::make_shared<SlotBlocks>(header.sliceAxis, std::move(all), std::move(storage));
    return decoded;
}

}  // namespace deltasplat
