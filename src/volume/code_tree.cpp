// SPDX-License-Identifier: Apache-2.0
#include "volume/code_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "deltasplat/error.h"
#include "volume/code_kernels.h"
#include "volume/code_nodes.h"
#include "volume/leaf_slices.h"
#include "volume/slot_blocks.h"

template <>
std::string openvdb::tree::LeafNode<deltasplat::Code, 3>::str() const {
    return "a leaf of codes";
}
template class openvdb::tree::LeafNode<deltasplat::Code, 3>;
template class openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>;
template class openvdb::tree::InternalNode<
    openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>, 5>;
template class openvdb::tree::Tree<openvdb::tree::RootNode<openvdb::tree::InternalNode<
    openvdb::tree::InternalNode<openvdb::tree::LeafNode<deltasplat::Code, 3>, 4>, 5>>>;

namespace deltasplat {

CodeLeaf describeLeaf(const CodeTree::Leaf& leaf, std::span<const Code> codes) {
    const auto [lowest, highest] = rangeOfCodes(codes);
    return {&leaf, leaf.origin(), lowest, highest};
}

CodeLeaf describeLeaf(const CodeTree::Leaf& leaf) {
    const Code* codes = leaf.buffer().data();
    if (leaf.isDense()) return describeLeaf(leaf, {codes, CodeTree::Leaf::SIZE});
    CodeLeaf described = describeLeaf(leaf, {codes + leaf.valueMask().findFirstOn(), 1});
    for (auto on = leaf.valueMask().beginOn(); on; ++on) {
        described.lowest = std::min(described.lowest, codes[on.pos()]);
        described.highest = std::max(described.highest, codes[on.pos()]);
    }
    return described;
}

namespace {

std::vector<CodeLeaf> listLeaves(const CodeTree::Tree& tree) {
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    // Leaves without active voxels may lie outside of the active box.
    std::erase_if(leaves, [](const CodeTree::Leaf* leaf) { return leaf->isEmpty(); });
    std::vector<CodeLeaf> described(leaves.size());
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) described[i] = describeLeaf(*leaves[i]);
    });
    return described;
}

// A block and the place of its first voxel.
struct PlacedBlock {
    openvdb::Coord origin;
    const SlotBlock* block;
};

// Sorts by node, so that blocks of one node are neighbours.
bool isBefore(const PlacedBlock& a, const PlacedBlock& b) {
    constexpr int kNode = CodeTree::Tree::RootNodeType::ChildNodeType::ChildNodeType::DIM;
    const openvdb::Coord nodeA = a.origin & ~(kNode - 1);
    const openvdb::Coord nodeB = b.origin & ~(kNode - 1);
    return nodeA != nodeB ? nodeA < nodeB : a.origin < b.origin;
}

// @param leaf  without room for codes
void fillLeaf(const SlotBlock& block, int sliceAxis, CodeTree::Leaf& leaf) {
    expectPieces(CodeTree::Leaf::SIZE * sizeof(Code));
    leaf.allocate();
    Code* const codes = leaf.buffer().data();
    std::array<std::uint64_t, 8> mask{};
    const ShortSlot* slot = block.slots;
    forLeafVoxels(sliceAxis, [&](const glm::ivec3&, int n) {
        const bool isActive = *slot != kEmptySlot;
        codes[n] = isActive ? Code(*slot - 1) : Code{0};
        mask[std::size_t(n) / 64] |= std::uint64_t{isActive} << (n % 64);
        ++slot;
    });
    for (openvdb::Index x = 0; x < mask.size(); ++x)
        leaf.getValueMask().getWord<std::uint64_t>(x) = mask[x];
}

// Returns the tree's leaves.
std::vector<CodeLeaf> fillTree(const SlotBlocks& blocks, CodeTree::Tree& tree) {
    // A leaf with its mask, its codes and its CodeLeaf.
    constexpr double kLeafBytes = sizeof(CodeTree::Leaf) + 512 * sizeof(Code) + 64;
    requireMemory("codes of a delta grid that is not seen along its slices",
                  kLeafBytes * double(blocks.blocks().size()));
    std::vector<PlacedBlock> placed;
    placed.reserve(blocks.blocks().size());
    for (const SlotBlock& block : blocks.blocks())
        placed.push_back({blockOrigin(block.position, blocks.sliceAxis()), &block});
    parallelSort(placed, isBefore);
    std::vector<openvdb::Coord> places;
    std::vector<const SlotBlock*> ofLeaves;
    std::vector<TilePlace> tiles;
    std::vector<Code> tileCodes;
    for (const PlacedBlock& one : placed) {
        if (one.block->slots) {
            places.push_back(one.origin);
            ofLeaves.push_back(one.block);
        } else {
            tiles.push_back({one.origin, 1});
            tileCodes.push_back(Code(one.block->tileSlot - 1));
        }
    }
    const std::vector<CodeTree::Leaf*> leaves = addNodes(places, tiles, tileCodes, tree);
    std::vector<CodeLeaf> described(leaves.size());
    parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            fillLeaf(*ofLeaves[i], blocks.sliceAxis(), *leaves[i]);
            described[i] = {leaves[i], leaves[i]->origin(), ofLeaves[i]->lowest,
                            ofLeaves[i]->highest};
        }
    });
    return described;
}

bool lacks(const CodeTree::Leaf& leaf) {
    return leaf.buffer().empty();
}

void dropCodes(CodeTree::Leaf& leaf) {
    CodeTree::Leaf::Buffer none(openvdb::PartialCreate(), Code{0});
    leaf.swap(none);
}

}  // namespace

CodeTree::CodeTree(std::shared_ptr<const SlotBlocks> blocks) : blocks_(std::move(blocks)) {}

CodeTree::~CodeTree() = default;

const CodeTree::Tree& CodeTree::tree() const {
    if (lacksLeaves()) readAll();
    return nodes();
}

const CodeTree::Tree& CodeTree::nodes() const {
    if (!blocks_ || hasTree_.load(std::memory_order_acquire)) return tree_;
    const std::lock_guard lock(mutex_);
    // A task that this thread runs while it waits might want the same tree.
    if (!hasTree_.load(std::memory_order_relaxed)) {
        isolated([&] {
            try {
                leaves_.store(
                    std::make_shared<const std::vector<CodeLeaf>>(fillTree(*blocks_, tree_)));
            } catch (...) {
                // The next call starts again.
                tree_.clear();
                throw;
            }
        });
    }
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
    // Two threads may do this at once; their lists are the same.
    known = std::make_shared<const std::vector<CodeLeaf>>(listLeaves(tree()));
    leaves_.store(known);
    return known;
}

void CodeTree::noteLeaves(std::vector<CodeLeaf> leaves, std::unique_ptr<const LeafReader> reader) {
    if (reader) {
        parallelForChunks(leaves.size(), [&](std::size_t begin, std::size_t end) {
            const auto of = std::span(leaves).subspan(begin, end - begin);
            leftToRead_ += std::size_t(std::count_if(
                of.begin(), of.end(), [](const CodeLeaf& one) { return lacks(*one.leaf); }));
        });
        if (lacksLeaves()) reader_ = std::move(reader);
    }
    leaves_.store(std::make_shared<const std::vector<CodeLeaf>>(std::move(leaves)));
}

void CodeTree::readLeaves(std::span<const Leaf* const> leaves) const {
    if (!lacksLeaves()) return;
    const std::lock_guard lock(mutex_);
    std::vector<Leaf*> lacking;
    for (const Leaf* leaf : leaves) {
        // The tree, which owns the leaf, is not const.
        if (lacks(*leaf)) lacking.push_back(const_cast<Leaf*>(leaf));
    }
    if (lacking.empty()) return;
    requireMemory("codes of a volume", double(Leaf::SIZE * sizeof(Code)) * double(lacking.size()));
    isolated([&] {
        try {
            reader_->read(lacking);
        } catch (...) {
            // Codes read so far may come from another file than the rest.
            for (Leaf* leaf : lacking) dropCodes(*leaf);
            throw;
        }
    });
    if (lacking.size() == leftToRead_) reader_.reset();
    leftToRead_ -= lacking.size();
}

void CodeTree::readAll() const {
    std::vector<const Leaf*> leaves;
    for (const CodeLeaf& one : *leaves_.load()) leaves.push_back(one.leaf);
    readLeaves(leaves);
}

}  // namespace deltasplat
