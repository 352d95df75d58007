// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/slot_blocks.h"

#include <algorithm>
#include <glm/common.hpp>
#include <tuple>
#include <utility>

namespace deltasplat {
namespace {

auto keyOf(const glm::ivec3& position) {
    return std::tuple(position.y, position.z, position.x);
}

}  // namespace

SlotBlocks::SlotBlocks(int sliceAxis, std::vector<SlotBlock> blocks,
                       std::vector<std::unique_ptr<ShortSlot[]>> storage)
    : sliceAxis_(sliceAxis), blocks_(std::move(blocks)), storage_(std::move(storage)) {
    if (blocks_.empty()) return;
    glm::ivec2 first(blocks_.front().position.y, blocks_.front().position.z), last = first;
    for (const SlotBlock& block : blocks_) {
        const glm::ivec2 column(block.position.y, block.position.z);
        first = glm::min(first, column);
        last = glm::max(last, column);
    }
    const glm::dvec2 sides = glm::dvec2(last) - glm::dvec2(first) + 1.0;
    if (sides.x * sides.y > 4.0 * double(blocks_.size()) + 1024) return;
    firstColumn_ = first;
    columns_ = last - first + 1;
    begins_.reserve(std::size_t(columns_.x) * std::size_t(columns_.y) + 1);
    std::size_t next = 0;
    for (int u = first.x; u <= last.x; ++u) {
        for (int v = first.y; v <= last.y; ++v) {
            begins_.push_back(next);
            const auto isHere = [&](const SlotBlock& block) {
                return block.position.y == u && block.position.z == v;
            };
            while (next < blocks_.size() && isHere(blocks_[next])) ++next;
        }
    }
    begins_.push_back(next);
}

const SlotBlock* SlotBlocks::find(const glm::ivec3& position) const {
    auto begin = blocks_.begin(), end = blocks_.end();
    if (!begins_.empty()) {
        const glm::ivec2 column = glm::ivec2(position.y, position.z) - firstColumn_;
        if (column.x < 0 || column.y < 0 || column.x >= columns_.x || column.y >= columns_.y)
            return nullptr;
        const auto i = std::size_t(column.x) * std::size_t(columns_.y) + std::size_t(column.y);
        begin = blocks_.begin() + std::ptrdiff_t(begins_[i]);
        end = blocks_.begin() + std::ptrdiff_t(begins_[i + 1]);
        // Mostly none is missing.
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

std::size_t SlotBlocks::memoryBytes() const {
    std::size_t stored = 0;
    for (const SlotBlock& block : blocks_) stored += block.slots ? 1 : 0;
    return stored * 512 * sizeof(ShortSlot) + blocks_.size() * sizeof(SlotBlock) +
           begins_.size() * sizeof(std::size_t);
}

}  // namespace deltasplat
