// SPDX-License-Identifier: Apache-2.0
#include "volume/code_blocks.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "deltasplat/threads.h"
#include "volume/leaf_slices.h"
#include "volume/slot_blocks.h"

namespace deltasplat {

namespace {

constexpr double kBytesPerBlock = sizeof(CodeBlock) + 16 + 128;

template <typename Node, typename SlotOf, typename Use>
void forVisibleTilesOf(const Node& node, const SlotOf& slotOf, const Use& use) {
    for (auto tile = node.cbeginValueOn(); tile; ++tile) {
        const Slot slot = slotOf(*tile);
        if (slot == kEmptySlot) continue;
        use(openvdb::CoordBBox::createCube(tile.getCoord(), Node::ChildNodeType::DIM), slot);
    }
}

// Calls use(box, slot) for active tiles with a slot. OpenVDB's whole-tree iterators visit leaves.
template <typename SlotOf, typename Use>
void forVisibleTiles(const CodeTree& codes, const SlotOf& slotOf, const Use& use) {
    using Upper = CodeTree::Tree::RootNodeType::ChildNodeType;
    using Lower = Upper::ChildNodeType;
    forVisibleTilesOf(codes.nodes().root(), slotOf, use);
    std::vector<const Upper*> uppers;
    codes.nodes().getNodes(uppers);
    for (const Upper* node : uppers) forVisibleTilesOf(*node, slotOf, use);
    std::vector<const Lower*> lowers;
    codes.nodes().getNodes(lowers);
    for (const Lower* node : lowers) forVisibleTilesOf(*node, slotOf, use);
}

SeenCodes seenCodes(std::span<const Slot> slotMap) {
    return SeenCodes([&](int code) { return slotMap[std::size_t(code) + 1] != kEmptySlot; });
}

// Returns, in parts, the leaves with active voxels whose slots may be other than empty.
// @param cone  null, or leaves outside of it are left out
std::vector<std::vector<CodeBlock>> visibleLeaves(const CodeTree& codes, int sliceAxis,
                                                  std::span<const Slot> slotMap,
                                                  const SeenCone* cone) {
    constexpr std::size_t kPart = 4096;
    const auto all = codes.leaves();
    std::optional<SeenCodes> seen;
    if (!slotMap.empty()) seen = seenCodes(slotMap);
    const std::size_t count = (all->size() + kPart - 1) / kPart;
    std::vector<std::vector<CodeBlock>> parts(count);
    // Includes leaves outside of the cone, because most are needed in the end.
    std::vector<std::vector<const CodeTree::Leaf*>> toRead(codes.lacksLeaves() ? count : 0);
    parallelFor(parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kPart, all->size());
        for (std::size_t i = part * kPart; i < end; ++i) {
            const CodeLeaf& one = (*all)[i];
            if (seen && !seen->hasAny(one.lowest, one.highest)) continue;
            if (!toRead.empty()) toRead[part].push_back(one.leaf);
            // Shifting rounds negative positions down.
            const glm::ivec3 position = toSliceOrder(one.origin >> 3, sliceAxis);
            if (cone && !cone->sees(position)) continue;
            parts[part].push_back(
                {position, one.leaf, kEmptySlot, nullptr, one.lowest, one.highest});
        }
    });
    std::vector<const CodeTree::Leaf*> leaves;
    for (const auto& part : toRead) leaves.insert(leaves.end(), part.begin(), part.end());
    codes.readLeaves(leaves);
    return parts;
}

Slot inactiveSlot(Code number) {
    return kSlotCount + number;
}

using BlockParts = std::vector<std::vector<CodeBlock>>;

struct ColumnBox {
    glm::i64vec2 first{std::numeric_limits<std::int64_t>::max()};
    glm::i64vec2 last{std::numeric_limits<std::int64_t>::min()};

    void include(const ColumnBox& other) {
        first = glm::min(first, other.first);
        last = glm::max(last, other.last);
    }
};

// As comesBefore. At the same place, the block without inactive voxels comes first.
bool comesFirst(const CodeBlock& a, const CodeBlock& b) {
    if (a.position == b.position) return !a.inactive && b.inactive;
    return comesBefore(a, b);
}

// Returns blocks by u, then v, then slice. Sorts by counting the blocks per column. Within a column
// one thread mostly finds them in order, because trees list leaves in order along every axis.
std::vector<CodeBlock> inColumns(const BlockParts& parts) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    std::vector<CodeBlock> sorted;
    if (count == 0) return sorted;
    // One thread finishes this many before other threads start.
    constexpr std::size_t kFew = 8192;
    const bool isAlone = count < kFew || threadCount() == 1;
    const auto forPieces = [&](std::size_t pieces, const auto& use) {
        isAlone ? use(std::size_t{0}, pieces) : parallelForChunks(pieces, use);
    };
    const auto forBlocks = [&](const auto& use) {
        forPieces(parts.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (const CodeBlock& block : parts[i]) use(i, block);
        });
    };
    std::vector<ColumnBox> boxes(parts.size());
    forBlocks([&](std::size_t i, const CodeBlock& block) {
        const glm::i64vec2 column(block.position.y, block.position.z);
        boxes[i].include({column, column});
    });
    ColumnBox box;
    for (const ColumnBox& one : boxes) box.include(one);
    const glm::i64vec2 size = box.last - box.first + std::int64_t{1};
    // If blocks lie far apart, there are too many columns.
    constexpr double kMostColumnsPerBlock = 4;
    if (double(size.x) * double(size.y) > kMostColumnsPerBlock * double(count)) {
        sorted.reserve(count);
        for (const auto& part : parts) sorted.insert(sorted.end(), part.begin(), part.end());
        parallelSort(sorted, comesFirst);
        return sorted;
    }
    const auto columnOf = [&](const CodeBlock& block) {
        const glm::i64vec2 at = glm::i64vec2(block.position.y, block.position.z) - box.first;
        return std::size_t(at.x * size.y + at.y);
    };
    std::vector<std::atomic<std::size_t>> ends(std::size_t(size.x * size.y));  // [column]
    const auto countUp = [&](std::atomic<std::size_t>& number) {
        constexpr auto kAnyOrder = std::memory_order_relaxed;
        if (!isAlone) return number.fetch_add(1, kAnyOrder);
        const std::size_t before = number.load(kAnyOrder);
        number.store(before + 1, kAnyOrder);
        return before;
    };
    forBlocks([&](std::size_t, const CodeBlock& block) { countUp(ends[columnOf(block)]); });
    std::size_t before = 0;
    for (auto& end : ends) before += end.exchange(before, std::memory_order_relaxed);
    sorted.resize(count);
    forBlocks([&](std::size_t, const CodeBlock& block) {
        sorted[countUp(ends[columnOf(block)])] = block;
    });
    forPieces(ends.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t begin = i == 0 ? 0 : std::size_t(ends[i - 1]);
            const std::span column = std::span(sorted).subspan(begin, ends[i] - begin);
            if (!std::is_sorted(column.begin(), column.end(), comesFirst))
                std::sort(column.begin(), column.end(), comesFirst);
        }
    });
    return sorted;
}

}  // namespace

BlockReader::BlockReader(const CodeTree& codes, const CodeTree* inactive, int sliceAxis,
                         std::span<const Slot> slotMap, const SeenCone* seen)
    : slotMap_(slotMap), sliceAxis_(sliceAxis), blocks_(listBlocks(codes, inactive, seen)) {
    if (inactive) mergeDoubles();
}

std::vector<CodeBlock> BlockReader::listBlocks(const CodeTree& codes, const CodeTree* inactive,
                                               const SeenCone* seen) const {
    BlockParts parts = visibleLeaves(codes, sliceAxis_, slotMap_, seen);
    // A tile may stand for any number of blocks, so count them before listing.
    double leaves = 0;
    for (const auto& part : parts) leaves += double(part.size());
    double pieces = 0;  // of tiles, and leaves of inactive voxels
    if (inactive) pieces += inactive->tree().leafCount();
    const auto slotOfCode = [this](Code code) { return slotOf(code); };
    const auto count = [&](const openvdb::CoordBBox& box, Slot) { pieces += box.volume() / 512.0; };
    forVisibleTiles(codes, slotOfCode, count);
    if (inactive) forVisibleTiles(*inactive, inactiveSlot, count);
    requireMemory("list of voxel blocks", (leaves + pieces) * kBytesPerBlock);

    std::vector<CodeBlock>& more = parts.emplace_back();
    more.reserve(std::size_t(pieces));
    const auto add = [&](const openvdb::CoordBBox& box, Slot slot) {
        addTile(box, slot, seen, more);
    };
    forVisibleTiles(codes, slotOfCode, add);
    if (inactive) {
        for (auto leaf = inactive->tree().cbeginLeaf(); leaf; ++leaf) {
            more.push_back(
                {toSliceOrder(leaf->origin() >> 3, sliceAxis_), nullptr, kEmptySlot, &*leaf});
        }
        forVisibleTiles(*inactive, inactiveSlot, add);
    }
    return inColumns(parts);
}

// Merges entries of a block with both active voxels and inactive voxels with values.
void BlockReader::mergeDoubles() {
    std::size_t kept = 0;
    for (const CodeBlock& next : blocks_) {
        if (kept > 0 && blocks_[kept - 1].position == next.position) {
            CodeBlock& block = blocks_[kept - 1];
            if (!block.leaf) block.leaf = next.leaf;
            if (!block.inactive) block.inactive = next.inactive;
            if (block.tileSlot == kEmptySlot) block.tileSlot = next.tileSlot;
        } else {
            blocks_[kept++] = next;
        }
    }
    blocks_.resize(kept);
}

void BlockReader::addTile(const openvdb::CoordBBox& box, Slot slot, const SeenCone* seen,
                          std::vector<CodeBlock>& blocks) const {
    const glm::ivec3 first = toSliceOrder(box.min() >> 3, sliceAxis_);
    const glm::ivec3 last = toSliceOrder(box.max() >> 3, sliceAxis_);
    for (int u = first.y; u <= last.y; ++u) {
        for (int v = first.z; v <= last.z; ++v) {
            for (int s = first.x; s <= last.x; ++s) {
                if (!seen || seen->sees({s, u, v}))
                    blocks.push_back({{s, u, v}, nullptr, slot, nullptr});
            }
        }
    }
}

void BlockReader::readBlock(const CodeBlock& block, BlockSlots& slots) const {
    if (block.leaf) {
        readLeafSlices(
            *block.leaf, sliceAxis_, [this](Code code) { return slotOf(code); }, slots.data());
    } else {
        slots.fill(block.inactive ? kEmptySlot : block.tileSlot);
    }
    readInactive(block, 0, slots.data());
}

void BlockReader::readLastSlice(const CodeBlock& block, std::span<Slot, 64> slots) const {
    if (block.leaf) {
        const Code* codes = block.leaf->buffer().data();
        const auto& active = block.leaf->getValueMask();
        Slot* slot = slots.data();
        forLeafVoxels(sliceAxis_, {7, 0, 0}, glm::ivec3(7), [&](const glm::ivec3&, int n) {
            *slot++ = active.isOn(openvdb::Index(n)) ? slotOf(codes[n]) : kEmptySlot;
        });
    } else {
        std::fill(slots.begin(), slots.end(), block.inactive ? kEmptySlot : block.tileSlot);
    }
    readInactive(block, 7, slots.data());
}

// Adds inactive voxels with values of their own. `slots` begins with slice `firstSlice`.
void BlockReader::readInactive(const CodeBlock& block, int firstSlice, Slot* slots) const {
    if (!block.inactive) return;
    const Code* numbers = block.inactive->buffer().data();
    const auto& active = block.inactive->getValueMask();
    forLeafVoxels(sliceAxis_, {firstSlice, 0, 0}, glm::ivec3(7), [&](const glm::ivec3&, int n) {
        if (active.isOn(openvdb::Index(n))) *slots = inactiveSlot(numbers[n]);
        ++slots;
    });
}

std::vector<CodeBlock> listBlocks(const CodeTree& codes, int sliceAxis,
                                  std::span<const Slot> slotMap, const SeenCone* seen) {
    const SlotBlocks* const along = codes.blocksAlong(sliceAxis);
    if (!along) return BlockReader(codes, nullptr, sliceAxis, slotMap, seen).takeBlocks();
    const SeenCodes codesSeen = seenCodes(slotMap);
    const auto isSeen = [&](const SlotBlock& block) {
        return codesSeen.hasAny(block.lowest, block.highest) &&
               (!seen || seen->sees(block.position));
    };
    const auto all = along->blocksWith(codesSeen);
    const auto count = std::count_if(all->begin(), all->end(), isSeen);
    requireMemory("list of voxel blocks", double(count) * kBytesPerBlock);
    std::vector<CodeBlock> blocks;
    blocks.reserve(std::size_t(count));
    for (const SlotBlock& block : *all) {
        if (!isSeen(block)) continue;
        const Slot tile = block.slots ? kEmptySlot : slotMap[std::size_t(block.tileSlot)];
        blocks.push_back(
            {block.position, nullptr, tile, nullptr, block.lowest, block.highest, block.slots});
    }
    return blocks;
}

}  // namespace deltasplat
