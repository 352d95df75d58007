// SPDX-License-Identifier: Apache-2.0
#include "delta/code_blocks.h"

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <optional>
#include <utility>

#include "ingest/codes/leaf_slices.h"
#include "memory.h"
#include "parallel.h"
#include "parallel_sort.h"

namespace deltasplat {
namespace {

// What the stage keeps for each block: itself, its place and its changes.
constexpr double kBytesPerBlock = sizeof(CodeBlock) + 16 + 128;

// Calls use(box, slot) for every active tile in a node whose slot is not empty.
template <typename Node, typename SlotOf, typename Use>
void forVisibleTilesOf(const Node& node, const SlotOf& slotOf, const Use& use) {
    for (auto tile = node.cbeginValueOn(); tile; ++tile) {
        const Slot slot = slotOf(*tile);
        if (slot == kEmptySlot) continue;
        use(openvdb::CoordBBox::createCube(tile.getCoord(), Node::ChildNodeType::DIM), slot);
    }
}

// Calls use(box, slot) for every active tile whose slot is not empty. Node by node: OpenVDB's
// iterators over a whole tree stop at every leaf on the way.
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

// Tells which blocks may have slots other than empty, by the range of their codes.
class SeenCodes {
  public:
    explicit SeenCodes(std::span<const Slot> slotMap) : before_(kSlotCount, 0) {
        for (int code = 0; code < kCodeCount; ++code)
            before_[code + 1] = before_[code] + (slotMap[code + 1] != kEmptySlot);
    }
    bool hasAny(Code lowest, Code highest) const { return before_[highest + 1] != before_[lowest]; }

  private:
    std::vector<int> before_;  // how many codes before each have a slot
};

// Returns, in parts, the leaves with active voxels whose slots may be other than empty.
// @param cone  null, or what else is left out
std::vector<std::vector<CodeBlock>> visibleLeaves(const CodeTree& codes, int sliceAxis,
                                                  std::span<const Slot> slotMap,
                                                  const SeenCone* cone) {
    constexpr std::size_t kPart = 4096;
    const auto all = codes.leaves();
    std::optional<SeenCodes> seen;
    if (!slotMap.empty()) seen.emplace(slotMap);
    const std::size_t count = (all->size() + kPart - 1) / kPart;
    std::vector<std::vector<CodeBlock>> parts(count);
    // Those that other cones see as well: all are mostly wanted in the end.
    std::vector<std::vector<const CodeTree::Leaf*>> toRead(codes.lacksLeaves() ? count : 0);
    parallelFor(parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kPart, all->size());
        for (std::size_t i = part * kPart; i < end; ++i) {
            const CodeLeaf& one = (*all)[i];
            if (seen && !seen->hasAny(one.lowest, one.highest)) continue;
            if (!toRead.empty()) toRead[part].push_back(one.leaf);
            // Shifting keeps the floor of negative positions.
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

// Orders blocks by u, then v, then slice. Those of each column are counted and put into place, in
// which they mostly are in order: trees list leaves so, whatever the axis.
void sortByColumn(std::vector<CodeBlock>& blocks) {
    if (blocks.empty()) return;
    glm::i64vec2 first(blocks.front().position.y, blocks.front().position.z);
    glm::i64vec2 last = first;
    for (const CodeBlock& block : blocks) {
        const glm::i64vec2 column(block.position.y, block.position.z);
        first = glm::min(first, column);
        last = glm::max(last, column);
    }
    const glm::i64vec2 size = last - first + std::int64_t{1};
    // Where blocks lie far apart there are too many columns.
    constexpr double kMostColumnsPerBlock = 4;
    if (double(size.x) * double(size.y) > kMostColumnsPerBlock * double(blocks.size()))
        return parallelSort(blocks, comesBefore);
    const auto columnOf = [&](const CodeBlock& block) {
        return std::size_t((block.position.y - first.x) * size.y + (block.position.z - first.y));
    };
    std::vector<std::size_t> ends(std::size_t(size.x * size.y));  // of columns
    for (const CodeBlock& block : blocks) ++ends[columnOf(block)];
    std::size_t before = 0;
    for (std::size_t& end : ends) before += std::exchange(end, before);
    std::vector<CodeBlock> sorted(blocks.size());
    for (const CodeBlock& block : blocks) sorted[ends[columnOf(block)]++] = block;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        const std::span column = std::span(sorted).subspan(begin, end - begin);
        if (!std::is_sorted(column.begin(), column.end(), comesBefore))
            std::sort(column.begin(), column.end(), comesBefore);
        begin = end;
    }
    blocks = std::move(sorted);
}

}  // namespace

BlockReader::BlockReader(const CodeTree& codes, const CodeTree* inactive, int sliceAxis,
                         std::span<const Slot> slotMap, const SeenCone* seen)
    : slotMap_(slotMap), sliceAxis_(sliceAxis) {
    listBlocks(codes, inactive, seen);
    sortByColumn(blocks_);
    if (inactive) mergeDoubles();
}

void BlockReader::listBlocks(const CodeTree& codes, const CodeTree* inactive,
                             const SeenCone* seen) {
    const std::vector<std::vector<CodeBlock>> leaves =
        visibleLeaves(codes, sliceAxis_, slotMap_, seen);
    // A tile may stand for any number of blocks: know how many before they are listed.
    double blocks = 0;
    for (const std::vector<CodeBlock>& part : leaves) blocks += double(part.size());
    const auto slotOfCode = [this](Code code) { return slotOf(code); };
    const auto count = [&](const openvdb::CoordBBox& box, Slot) { blocks += box.volume() / 512.0; };
    forVisibleTiles(codes, slotOfCode, count);
    if (inactive) blocks += inactive->tree().leafCount();
    if (inactive) forVisibleTiles(*inactive, inactiveSlot, count);
    requireMemory("list of voxel blocks", blocks * kBytesPerBlock);

    blocks_.reserve(std::size_t(blocks));
    for (const std::vector<CodeBlock>& part : leaves)
        blocks_.insert(blocks_.end(), part.begin(), part.end());
    const auto add = [&](const openvdb::CoordBBox& box, Slot slot) { addTile(box, slot, seen); };
    forVisibleTiles(codes, slotOfCode, add);
    if (!inactive) return;
    for (auto leaf = inactive->tree().cbeginLeaf(); leaf; ++leaf) {
        blocks_.push_back(
            {toSliceOrder(leaf->origin() >> 3, sliceAxis_), nullptr, kEmptySlot, &*leaf});
    }
    forVisibleTiles(*inactive, inactiveSlot, add);
}

// A block may have both active voxels and inactive ones with values: two entries become one.
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

void BlockReader::addTile(const openvdb::CoordBBox& box, Slot slot, const SeenCone* seen) {
    const glm::ivec3 first = toSliceOrder(box.min() >> 3, sliceAxis_);
    const glm::ivec3 last = toSliceOrder(box.max() >> 3, sliceAxis_);
    for (int u = first.y; u <= last.y; ++u) {
        for (int v = first.z; v <= last.z; ++v) {
            for (int s = first.x; s <= last.x; ++s) {
                if (!seen || seen->sees({s, u, v}))
                    blocks_.push_back({{s, u, v}, nullptr, slot, nullptr});
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

// Adds inactive voxels that hold a value of their own to slots that begin with a slice.
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
    const SeenCodes seenCodes(slotMap);
    const auto isSeen = [&](const SlotBlock& block) {
        return seenCodes.hasAny(block.lowest, block.highest) &&
               (!seen || seen->sees(block.position));
    };
    const auto count = std::count_if(along->blocks().begin(), along->blocks().end(), isSeen);
    requireMemory("list of voxel blocks", double(count) * kBytesPerBlock);
    std::vector<CodeBlock> blocks;
    blocks.reserve(std::size_t(count));
    for (const SlotBlock& block : along->blocks()) {
        if (!isSeen(block)) continue;
        const Slot tile = block.slots ? kEmptySlot : slotMap[std::size_t(block.tileSlot)];
        blocks.push_back(
            {block.position, nullptr, tile, nullptr, block.lowest, block.highest, block.slots});
    }
    return blocks;
}

}  // namespace deltasplat
