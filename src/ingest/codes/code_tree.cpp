// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/code_tree.h"

#include <algorithm>

#include "deltasplat/error.h"
#include "ingest/codes/leaf_slices.h"
#include "ingest/codes/slot_blocks.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {

CodeLeaf describeLeaf(const CodeTree::Leaf& leaf) {
    const Code* codes = leaf.buffer().data();
    CodeLeaf described{&leaf, codes[leaf.valueMask().findFirstOn()], 0};
    const auto add = [&](Code code) {
        described.lowest = std::min(described.lowest, code);
        described.highest = std::max(described.highest, code);
    };
    if (leaf.isDense()) {
        for (openvdb::Index n = 0; n < CodeTree::Leaf::SIZE; ++n) add(codes[n]);
    } else {
        for (auto on = leaf.valueMask().beginOn(); on; ++on) add(codes[on.pos()]);
    }
    return described;
}

namespace {

std::vector<CodeLeaf> listLeaves(const CodeTree::Tree& tree) {
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    // Leaves without active voxels may lie outside of the box of those.
    std::erase_if(leaves, [](const CodeTree::Leaf* leaf) { return leaf->isEmpty(); });
    std::vector<CodeLeaf> described(leaves.size());
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) described[i] = describeLeaf(*leaves[i]);
    });
    return described;
}

std::unique_ptr<CodeTree::Leaf> makeLeaf(const SlotBlock& block, int sliceAxis) {
    auto leaf = std::make_unique<CodeTree::Leaf>(blockOrigin(block.position, sliceAxis), Code{0},
                                                 /*active=*/false);
    const ShortSlot* slot = block.slots;
    forLeafVoxels(sliceAxis, [&](const glm::ivec3&, int n) {
        if (*slot != kEmptySlot) leaf->setValueOn(openvdb::Index(n), Code(*slot - 1));
        ++slot;
    });
    return leaf;
}

void fillTree(const SlotBlocks& blocks, CodeTree::Tree& tree) {
    // A leaf's codes and its mask, and what is kept of it beside them.
    constexpr double kLeafBytes = sizeof(CodeTree::Leaf) + 512 * sizeof(Code) + 64;
    requireMemory("codes of a delta grid that is not seen along its slices",
                  kLeafBytes * double(blocks.blocks().size()));
    std::vector<std::unique_ptr<CodeTree::Leaf>> leaves(blocks.blocks().size());
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SlotBlock& block = blocks.blocks()[i];
            if (block.slots) leaves[i] = makeLeaf(block, blocks.sliceAxis());
        }
    });
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(tree);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const SlotBlock& block = blocks.blocks()[i];
        if (leaves[i]) {
            accessor.addLeaf(leaves[i].release());
        } else {
            accessor.addTile(1, blockOrigin(block.position, blocks.sliceAxis()),
                             Code(block.tileSlot - 1), true);
        }
    }
}

}  // namespace

CodeTree::CodeTree(std::shared_ptr<const SlotBlocks> blocks) : blocks_(std::move(blocks)) {}

const CodeTree::Tree& CodeTree::tree() const {
    if (!blocks_ || hasTree_.load(std::memory_order_acquire)) return tree_;
    if (blocks_->facts()) {
        throw Error(ErrorCode::kFailed, gotExpected("volume", "some slices of a delta grid alone",
                                                    "a picture that is seen along these"));
    }
    const std::lock_guard lock(mutex_);
    // Work taken on while waiting here might want the same tree.
    if (!hasTree_.load(std::memory_order_relaxed)) isolated([&] { fillTree(*blocks_, tree_); });
    hasTree_.store(true, std::memory_order_release);
    return tree_;
}

const SlotBlocks* CodeTree::blocksAlong(int sliceAxis) const {
    return blocks_ && blocks_->sliceAxis() == sliceAxis ? blocks_.get() : nullptr;
}

std::uint64_t CodeTree::memoryBytes() const {
    const std::uint64_t ofBlocks = blocks_ ? blocks_->memoryBytes() : 0;
    return ofBlocks + (!blocks_ || hasTree_ ? tree_.memUsage() : 0);
}

std::shared_ptr<const std::vector<CodeLeaf>> CodeTree::leaves() const {
    auto known = leaves_.load();
    if (known) return known;
    // Two threads may do this at once; the lists are the same.
    known = std::make_shared<const std::vector<CodeLeaf>>(listLeaves(tree()));
    leaves_.store(known);
    return known;
}

}  // namespace deltasplat
