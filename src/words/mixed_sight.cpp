// SPDX-License-Identifier: Apache-2.0
#include "words/mixed_sight.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>

#include "base/memory.h"
#include "words/mix_window.h"

namespace deltasplat {
namespace {

// By u, then v, then slice.
bool liesBefore(const glm::ivec3& a, const glm::ivec3& b) {
    return std::tie(a.y, a.z, a.x) < std::tie(b.y, b.z, b.x);
}

// Adds the neighbours on both sides along an axis to places in order.
std::vector<glm::ivec3> widened(const std::vector<glm::ivec3>& places, const glm::ivec3& step) {
    const auto united = [](const auto& a, const auto& b) {
        std::vector<glm::ivec3> both;
        both.reserve(a.size() + b.size());
        std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both),
                       liesBefore);
        return both;
    };
    std::vector<glm::ivec3> before = places;
    for (glm::ivec3& place : before) place -= step;
    std::vector<glm::ivec3> behind = places;
    for (glm::ivec3& place : behind) place += step;
    return united(united(before, places), behind);
}

// Without any code if the lowest is above the highest.
struct Range {
    Code lowest = std::numeric_limits<Code>::max();
    Code highest = 0;

    void add(const Range& other) {
        lowest = std::min(lowest, other.lowest);
        highest = std::max(highest, other.highest);
    }
};

// Adds to the range of each block, in order, those of its neighbours on both sides along an axis.
void addNeighbours(const std::vector<CodeBlock>& blocks, const glm::ivec3& step,
                   std::vector<Range>& ranges) {
    const std::vector<Range> own = ranges;
    std::size_t next = 0;  // the first block that does not lie before the place looked for
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const glm::ivec3 place = blocks[i].position + step;
        while (next < blocks.size() && liesBefore(blocks[next].position, place)) ++next;
        if (next == blocks.size()) return;
        if (blocks[next].position != place) continue;
        ranges[i].add(own[next]);
        ranges[next].add(own[i]);
    }
}

}  // namespace

MixedSight::MixedSight(const ValueMixer& mixer, std::span<const Slot> slotMap, bool byAllSides)
    : mixer_(mixer), byAllSides_(byAllSides), before_(kSlotCount, 0) {
    for (std::size_t level = 0; level < kCodeCount; ++level)
        before_[level + 1] = before_[level] + (slotMap[level + 1] != kEmptySlot);
}

bool MixedSight::canBeSeen(const MixWindow& window) const {
    // Of empty slots, less one and without its sign, the lowest is nothing.
    constexpr int kMost = std::numeric_limits<int>::max();
    int lowest = kMost;
    int highest = kEmptySlot;
    for (const Slot slot : window.slots) {
        const int code = (slot - 1) & kMost;
        lowest = code < lowest ? code : lowest;
        highest = slot > highest ? slot : highest;
    }
    return highest != kEmptySlot && isSeenBetween(Code(lowest), Code(highest - 1));
}

// Returns a map [kSlotCount] that leaves the slots of codes which are seen, those of two clear ones
// that may be seen mixed with each other, and those of all codes if clear ones lie on both sides of
// what is seen: then clear blocks may be seen where they meet.
std::vector<Slot> MixedSight::seenCodes(std::span<const std::uint64_t> histogram) const {
    std::vector<Code> codes;
    for (std::size_t code = 0; code < histogram.size(); ++code)
        if (histogram[code] != 0) codes.push_back(Code(code));
    std::vector<bool> isSeen(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const std::size_t next = std::min(i + 1, codes.size() - 1);
        if (!isSeenBetween(codes[i], codes[next])) continue;
        // Clear ones beside those that are seen are found from these.
        const bool first = isSeenBetween(codes[i], codes[i]);
        const bool second = isSeenBetween(codes[next], codes[next]);
        if (first || !second) isSeen[i] = true;
        if (second || !first) isSeen[next] = true;
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

// What may be seen, or stays clear but lies beside it, and of that what is near enough.
std::vector<CodeBlock> MixedSight::listBlocks(const CodeTree& codes, int sliceAxis,
                                              std::span<const std::uint64_t> histogram) const {
    const std::vector<Slot> map = seenCodes(histogram);
    // Before others ask for some of the blocks: it wants all.
    const BlockFinder finder(codes, sliceAxis);
    const std::vector<CodeBlock> seen = deltasplat::listBlocks(codes, sliceAxis, map);
    constexpr double kMostNeighbours = 3;
    constexpr double kBytesPerBlock =
        sizeof(CodeBlock) + 4 * sizeof(glm::ivec3) + 2 * sizeof(Range);
    requireMemory("list of voxel blocks", kMostNeighbours * kBytesPerBlock * double(seen.size()));
    std::vector<glm::ivec3> places;
    places.reserve(seen.size());
    for (const CodeBlock& block : seen) places.push_back(block.position);
    places = widened(places, {1, 0, 0});
    const bool alongAll = byAllSides_ || mixer_.parts().within > 1;
    if (alongAll) places = widened(widened(places, {0, 0, 1}), {0, 1, 0});

    std::vector<CodeBlock> blocks;
    std::vector<Range> ranges;
    blocks.reserve(places.size());
    ranges.reserve(places.size());
    auto next = seen.begin();
    for (const glm::ivec3& place : places) {
        if (next != seen.end() && next->position == place) {
            blocks.push_back(*next++);
        } else if (std::optional<CodeBlock> found = finder.find(place)) {
            if (found->leaf) {
                const CodeLeaf leaf = describeLeaf(*found->leaf);
                found->lowest = leaf.lowest;
                found->highest = leaf.highest;
            }
            blocks.push_back(*found);
        } else if (byAllSides_) {
            blocks.push_back({place});
            ranges.push_back(Range());
            continue;
        } else {
            continue;
        }
        const CodeBlock& block = blocks.back();
        const auto tile = Code(block.tileSlot - 1);
        ranges.push_back(block.leaf || block.slots ? Range{block.lowest, block.highest}
                                                   : Range{tile, tile});
    }
    addNeighbours(blocks, {1, 0, 0}, ranges);
    if (alongAll) {
        // In the order in which values are mixed: what lies across a corner comes by the same way.
        addNeighbours(blocks, {0, 1, 0}, ranges);
        addNeighbours(blocks, {0, 0, 1}, ranges);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (ranges[i].lowest <= ranges[i].highest &&
            isSeenBetween(ranges[i].lowest, ranges[i].highest))
            blocks[kept++] = blocks[i];
    }
    blocks.resize(kept);
    return blocks;
}

}  // namespace deltasplat
