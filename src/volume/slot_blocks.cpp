// SPDX-License-Identifier: Apache-2.0
#include "volume/slot_blocks.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"

namespace deltasplat {

namespace {

auto keyOf(const glm::ivec3& position) {
    return std::tuple(position.y, position.z, position.x);
}

bool liesBefore(const SlotBlock& a, const SlotBlock& b) {
    return keyOf(a.position) < keyOf(b.position);
}

struct Wanted {
    std::vector<std::size_t> missing;
    std::vector<std::size_t> again;
};

// Returns the parts that lack blocks with seen codes. With null, any missing block counts.
Wanted wantedParts(const std::vector<BlockMaker::Part>& parts, const std::vector<bool>& isMade,
                   const std::vector<CodeRange>& leftOut, const SeenCodes* seen) {
    Wanted wanted;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const CodeRange lacks =
            isMade[i] ? leftOut[i] : std::pair(parts[i].lowest, parts[i].highest);
        if (!lacks || (seen && !seen->hasAny(lacks->first, lacks->second))) continue;
        (isMade[i] ? wanted.again : wanted.missing).push_back(i);
    }
    return wanted;
}

}  // namespace

struct SlotBlocks::Columns {
    explicit Columns(const std::vector<SlotBlock>& of);
    const SlotBlock* find(const glm::ivec3& position) const;

    const std::vector<SlotBlock>& blocks;
    // Empty if the rectangle is mostly empty.
    std::vector<std::size_t> begins;  // [u][v], and the end
    glm::ivec2 first{0};
    glm::ivec2 count{0};
};

SlotBlocks::Columns::Columns(const std::vector<SlotBlock>& of) : blocks(of) {
    if (blocks.empty()) return;
    first = glm::ivec2(blocks.front().position.y, blocks.front().position.z);
    glm::ivec2 last = first;
    for (const SlotBlock& block : blocks) {
        const glm::ivec2 column(block.position.y, block.position.z);
        first = glm::min(first, column);
        last = glm::max(last, column);
    }
    const glm::dvec2 sides = glm::dvec2(last) - glm::dvec2(first) + 1.0;
    if (sides.x * sides.y > 4.0 * double(blocks.size()) + 1024) return;
    count = last - first + 1;
    begins.reserve(std::size_t(count.x) * std::size_t(count.y) + 1);
    std::size_t next = 0;
    for (int u = first.x; u <= last.x; ++u) {
        for (int v = first.y; v <= last.y; ++v) {
            begins.push_back(next);
            const auto isHere = [&](const SlotBlock& block) {
                return block.position.y == u && block.position.z == v;
            };
            while (next < blocks.size() && isHere(blocks[next])) ++next;
        }
    }
    begins.push_back(next);
}

const SlotBlock* SlotBlocks::Columns::find(const glm::ivec3& position) const {
    auto begin = blocks.begin(), end = blocks.end();
    if (!begins.empty()) {
        const glm::ivec2 column = glm::ivec2(position.y, position.z) - first;
        if (column.x < 0 || column.y < 0 || column.x >= count.x || column.y >= count.y)
            return nullptr;
        const auto i = std::size_t(column.x) * std::size_t(count.y) + std::size_t(column.y);
        begin = blocks.begin() + std::ptrdiff_t(begins[i]);
        end = blocks.begin() + std::ptrdiff_t(begins[i + 1]);
        // Columns mostly have no gaps.
        const int behind = begin == end ? -1 : position.x - begin->position.x;
        if (behind >= 0 && behind < end - begin && (begin + behind)->position == position)
            return &*(begin + behind);
    }
    const auto found =
        std::lower_bound(begin, end, position, [](const SlotBlock& block, const glm::ivec3& place) {
            return keyOf(block.position) < keyOf(place);
        });
    return found != end && found->position == position ? &*found : nullptr;
}

SlotBlocks::SlotBlocks(int sliceAxis, std::vector<SlotBlock> blocks, SlotStorage storage)
    : sliceAxis_(sliceAxis),
      storage_(std::move(storage)),
      blocks_(std::make_shared<const std::vector<SlotBlock>>(std::move(blocks))),
      columns_(std::make_unique<const Columns>(*blocks_)),
      all_(columns_.get()) {}

SlotBlocks::SlotBlocks(int sliceAxis, std::unique_ptr<const BlockMaker> maker)
    : sliceAxis_(sliceAxis),
      blocks_(std::make_shared<const std::vector<SlotBlock>>()),
      maker_(std::move(maker)),
      isMade_(maker_->parts().size()),
      leftOut_(maker_->parts().size()) {}

SlotBlocks::~SlotBlocks() = default;

// Makes parts like BlockMaker::make. The caller holds the lock. A part that was made incompletely
// is made again as a whole, with new slots for blocks that exist already.
void SlotBlocks::makeParts(const std::vector<std::size_t>& parts, const SeenCodes* seen) const {
    if (parts.empty()) return;
    BlockMaker::Made made;
    // A task that this thread runs while it waits might want the same blocks.
    isolated([&] { made = maker_->make(parts, seen); });
    requireMemory("list of voxel blocks",
                  double(blocks_->size() + made.blocks.size()) * sizeof(SlotBlock));
    std::vector<SlotBlock> both;
    both.reserve(blocks_->size() + made.blocks.size());
    std::merge(blocks_->begin(), blocks_->end(), made.blocks.begin(), made.blocks.end(),
               std::back_inserter(both), liesBefore);
    // A part that is made again repeats some blocks.
    const auto areOne = [](const SlotBlock& a, const SlotBlock& b) {
        return a.position == b.position;
    };
    both.erase(std::unique(both.begin(), both.end(), areOne), both.end());
    auto blocks = std::make_shared<const std::vector<SlotBlock>>(std::move(both));
    storage_.reserve(storage_.size() + made.storage.size());
    // Nothing throws from here on.
    std::move(made.storage.begin(), made.storage.end(), std::back_inserter(storage_));
    blocks_ = std::move(blocks);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        isMade_[parts[i]] = true;
        leftOut_[parts[i]] = made.leftOut[i];
    }
}

const SlotBlocks::Columns& SlotBlocks::all() const {
    if (const Columns* const all = all_.load(std::memory_order_acquire)) return *all;
    const std::lock_guard lock(mutex_);
    if (maker_) {
        const Wanted wanted = wantedParts(maker_->parts(), isMade_, leftOut_, nullptr);
        makeParts(wanted.again, nullptr);
        makeParts(wanted.missing, nullptr);
        columns_ = std::make_unique<const Columns>(*blocks_);
        maker_.reset();
        all_.store(columns_.get(), std::memory_order_release);
    }
    return *columns_;
}

const std::vector<SlotBlock>& SlotBlocks::blocks() const {
    return all().blocks;
}

std::shared_ptr<const std::vector<SlotBlock>> SlotBlocks::blocksWith(const SeenCodes& seen) const {
    const std::lock_guard lock(mutex_);
    if (!maker_) return blocks_;
    const Wanted wanted = wantedParts(maker_->parts(), isMade_, leftOut_, &seen);
    makeParts(wanted.again, nullptr);
    makeParts(wanted.missing, &seen);
    return blocks_;
}

const SlotBlock* SlotBlocks::find(const glm::ivec3& position) const {
    return all().find(position);
}

std::size_t SlotBlocks::memoryBytes() const {
    const std::lock_guard lock(mutex_);
    std::size_t stored = 0;
    for (const SlotBlock& block : *blocks_) stored += block.slots ? 1 : 0;
    return stored * 512 * sizeof(ShortSlot) + blocks_->size() * sizeof(SlotBlock) +
           (columns_ ? columns_->begins.size() * sizeof(std::size_t) : 0);
}

}  // namespace deltasplat
