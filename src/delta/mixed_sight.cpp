// SPDX-License-Identifier: Apache-2.0
#include "delta/mixed_sight.h"

#include <algorithm>
#include <optional>

namespace deltasplat {
namespace {

// Finds the active blocks beside others.
class Neighbours {
  public:
    Neighbours(const CodeTree& codes, int sliceAxis)
        : accessor_(codes.tree), order_(sliceOrder(sliceAxis)) {}

    // Returns the block `step` blocks farther along the slice axis, if any of it is active.
    std::optional<CodeBlock> find(const CodeBlock& block, int step) const {
        CodeBlock found = block;
        found.position.x += step;
        openvdb::Coord origin;
        for (int i = 0; i < 3; ++i) origin[order_[i]] = 8 * found.position[i];
        found.leaf = accessor_.probeConstLeaf(origin);
        found.tileSlot = kEmptySlot;
        if (found.leaf) return found.leaf->isEmpty() ? std::nullopt : std::optional(found);
        Code code;
        if (!accessor_.probeValue(origin, code)) return std::nullopt;
        found.tileSlot = Slot(code + 1);
        return found;
    }

  private:
    openvdb::tree::ValueAccessor<const CodeTree::Tree> accessor_;
    glm::ivec3 order_;
};

bool isRightBehind(const CodeBlock& block, const CodeBlock& before) {
    return block.position == before.position + glm::ivec3(1, 0, 0);
}

}  // namespace

MixedSight::MixedSight(const SliceMixer& mixer, std::span<const Slot> slotMap)
    : mixer_(mixer), before_(kSlotCount, 0) {
    for (std::size_t level = 0; level < kCodeCount; ++level)
        before_[level + 1] = before_[level] + (slotMap[level + 1] != kEmptySlot);
}

bool MixedSight::canBeSeen(std::span<const CodeBlock> blocks) const {
    Code lowest = kCodeCount - 1;
    Code highest = 0;
    for (const CodeBlock& block : blocks) {
        lowest = std::min(lowest, block.leaf ? block.lowest : Code(block.tileSlot - 1));
        highest = std::max(highest, block.leaf ? block.highest : Code(block.tileSlot - 1));
    }
    return isSeenBetween(lowest, highest);
}

// Returns a map [kSlotCount] that leaves the slots of codes which may be seen mixed with the next
// larger or smaller one, and those of all codes if clear ones lie on both sides of what is seen:
// then clear blocks may be seen where they meet.
std::vector<Slot> MixedSight::seenCodes(std::span<const std::uint64_t> histogram) const {
    std::vector<Code> codes;
    for (std::size_t code = 0; code < histogram.size(); ++code)
        if (histogram[code] != 0) codes.push_back(Code(code));
    std::vector<bool> isSeen(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const std::size_t next = std::min(i + 1, codes.size() - 1);
        if (isSeenBetween(codes[i], codes[next])) isSeen[i] = isSeen[next] = true;
    }
    std::optional<int> side;
    bool bothSides = false;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        if (isSeen[i]) continue;
        if (side && *side != seenBefore(codes[i])) bothSides = true;
        side = seenBefore(codes[i]);
    }
    std::vector<Slot> map(kSlotCount, kEmptySlot);
    for (std::size_t i = 0; i < codes.size(); ++i)
        if (isSeen[i] || bothSides) map[std::size_t(codes[i]) + 1] = codes[i] + 1;
    return map;
}

std::vector<CodeBlock> MixedSight::listBlocks(const CodeTree& codes, int sliceAxis,
                                              std::span<const std::uint64_t> histogram) const {
    const std::vector<Slot> map = seenCodes(histogram);
    const BlockReader reader(codes, nullptr, sliceAxis, map);
    const std::vector<CodeBlock>& seen = reader.blocks();
    const Neighbours neighbours(codes, sliceAxis);
    std::vector<CodeBlock> blocks;
    blocks.reserve(seen.size() + seen.size() / 2);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto add = [&](int step) {
            if (const auto found = neighbours.find(seen[i], step)) blocks.push_back(*found);
        };
        const bool follows = !blocks.empty() && isRightBehind(seen[i], blocks.back());
        if (!follows) add(-1);
        blocks.push_back(seen[i]);
        if (i + 1 == seen.size() || !isRightBehind(seen[i + 1], seen[i])) add(1);
    }
    return blocks;
}

}  // namespace deltasplat
