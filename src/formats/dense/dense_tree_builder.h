// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "volume/code_nodes.h"

namespace deltasplat {

/// Builds the OpenVDB tree of a dense volume from layers of 8 slices. All voxels are active; whole
/// uniform blocks become tiles. Deterministic for any number of threads.
template <typename Tree>
class DenseTreeBuilder {
  public:
    using Leaf = typename Tree::LeafNodeType;
    using Value = typename Tree::ValueType;
    static constexpr int kBlock = Leaf::DIM;
    static constexpr int kBlockVoxels = Leaf::SIZE;

    /// @param tree  empty
    /// @param dims  voxels along x, y and z
    DenseTreeBuilder(Tree& tree, const glm::ivec3& dims)
        : dims_(dims),
          blocks_((dims + (kBlock - 1)) / kBlock),
          workers_(std::size_t(std::max(1, threadCount()))),
          tree_(tree),
          made_(std::size_t(blocks_.x) * std::size_t(blocks_.y) *
                std::size_t(std::min(blocks_.z, kNode))) {}

    std::size_t workers() const { return workers_; }

    /// Adds slices from firstSlice on, behind all slices added before.
    /// @param slices  a multiple of 8, or all that are left
    /// @param fill    fill(corner, size, values) writes the block at a voxel, counted from
    ///                firstSlice, into values[512] in leaf order; called from all threads
    /// @param tally   tally(worker, size, values) hears of each filled block
    template <typename Fill, typename Tally>
    void add(int firstSlice, int slices, const Fill& fill, const Tally& tally) {
        addBlocks(firstSlice, slices,
                  [&](std::size_t worker, const glm::ivec3& corner, std::span<Block> row) {
                      glm::ivec3 place = corner;
                      for (Block& block : row) {
                          block = makeBlock(worker, place, firstSlice, fill, tally);
                          place.x += kBlock;
                      }
                  });
    }

    /// Adds slices as add() does, but leaves most leaves to be read later: all but wanted ones and
    /// those of rows with few leaves.
    /// @param rowOf  rowOf(worker, y, z) returns an object for the row of blocks that starts at
    ///               this voxel: rangeOf(x) is the smallest and largest value of the block at x;
    ///               isWanted(low, high); read(leaf) fills a leaf. Called from all threads.
    template <typename RowOf>
    void addRanges(int firstSlice, int slices, const RowOf& rowOf) {
        addBlocks(firstSlice, slices,
                  [&](std::size_t worker, const glm::ivec3& corner, std::span<Block> row) {
                      makeRanges(corner, rowOf(worker, corner.y, corner.z), row);
                  });
    }

    /// Returns the leaves with their code ranges, after the last slice.
    std::vector<CodeLeaf> takeLeaves() {
        std::size_t count = 0;
        for (const std::vector<CodeLeaf>& ofNode : leaves_) count += ofNode.size();
        std::vector<CodeLeaf> leaves;
        leaves.reserve(count);
        for (const std::vector<CodeLeaf>& ofNode : leaves_)
            leaves.insert(leaves.end(), ofNode.begin(), ofNode.end());
        leaves_.clear();
        return leaves;
    }

    double worstBytes(int slices) const {
        constexpr std::size_t kBlockBytes =
            sizeof(Leaf) + kBlockVoxels * sizeof(Value) + (kHasCodes ? sizeof(CodeLeaf) : 0);
        const int layers = (slices + kBlock - 1) / kBlock;
        return double(blocks_.x) * blocks_.y * layers * kBlockBytes;
    }
    /// Returns the memory of the builder itself.
    static double bytes(const glm::ivec3& dims) {
        const glm::ivec3 blocks = (dims + (kBlock - 1)) / kBlock;
        return double(blocks.x) * blocks.y * std::min(blocks.z, kNode) * sizeof(Block);
    }

  private:
    using Lower = typename Tree::RootNodeType::ChildNodeType::ChildNodeType;
    static constexpr bool kHasCodes = std::is_same_v<Tree, CodeTree::Tree>;
    static constexpr int kNode = Lower::DIM / kBlock;  // blocks per node along an axis

    struct Block {
        std::unique_ptr<Leaf> leaf;  // empty: a tile of `low`
        Value low{};                 // range of a leaf's codes
        Value high{};
    };

    template <typename MakeRow>
    void addBlocks(int firstSlice, int slices, const MakeRow& makeRow) {
        const int firstLayer = firstSlice / kBlock;
        const int layers = (slices + kBlock - 1) / kBlock;
        for (int layer = firstLayer, count = 0; layer < firstLayer + layers; layer += count) {
            // Layers that share one row of nodes.
            count = std::min(firstLayer + layers, (layer / kNode + 1) * kNode) - layer;
            makeBlocks(layer, count, makeRow);
            if ((layer + count) % kNode == 0 || layer + count == blocks_.z)
                hangInRow(layer / kNode);
        }
    }

    glm::ivec3 sizeOf(const glm::ivec3& corner) const {
        return glm::min(dims_ - corner, glm::ivec3(kBlock));
    }
    static bool isWhole(const glm::ivec3& size) { return size == glm::ivec3(kBlock); }

    static bool isUniform(const Value* values) {
        // All neighbours are equal: libraries vectorise this comparison.
        const auto* bytes = reinterpret_cast<const std::byte*>(values);
        return std::memcmp(bytes, bytes + sizeof(Value), (kBlockVoxels - 1) * sizeof(Value)) == 0;
    }

    // Returns a leaf without values, active within the volume.
    static std::unique_ptr<Leaf> leafAt(const glm::ivec3& corner, const glm::ivec3& size) {
        expectPieces(sizeof(Leaf));
        auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(),
                                           openvdb::Coord(corner.x, corner.y, corner.z), Value{},
                                           /*active=*/true);
        if (isWhole(size)) return leaf;
        for (int x = 0; x < kBlock; ++x) {
            for (int y = 0; y < kBlock; ++y) {
                for (int z = 0; z < kBlock; ++z) {
                    const bool inside = x < size.x && y < size.y && z < size.z;
                    if (!inside) leaf->setValueOff(openvdb::Index(x * 64 + y * 8 + z));
                }
            }
        }
        return leaf;
    }

    template <typename MakeRow>
    void makeBlocks(int firstLayer, int layers, const MakeRow& makeRow) {
        std::atomic<int> next = 0;
        parallelFor(workers_, [&](std::size_t worker) {
            for (int row = next++; row < layers * blocks_.y; row = next++) {
                const int y = row % blocks_.y;
                const int z = firstLayer + row / blocks_.y;
                makeRow(worker, glm::ivec3(0, y, z) * kBlock,
                        std::span(&madeAt(0, y, z), std::size_t(blocks_.x)));
            }
        });
    }

    template <typename Row>
    void makeRanges(glm::ivec3 corner, const Row& row, std::span<Block> blocks) const {
        std::size_t leaves = 0;
        for (Block& block : blocks) {
            const glm::ivec3 size = sizeOf(corner);
            std::tie(block.low, block.high) = row.rangeOf(corner.x);
            const bool isUniform = block.low == block.high && isWhole(size);
            block.leaf = isUniform ? nullptr : leafAt(corner, size);
            if (block.leaf) {
                ++leaves;
                if (row.isWanted(block.low, block.high)) row.read(*block.leaf);
            }
            corner.x += kBlock;
        }
        // Reading a row again takes as long as making leaves of an eighth of it.
        if (8 * leaves > blocks.size()) return;
        for (const Block& block : blocks)
            if (block.leaf && block.leaf->buffer().empty()) row.read(*block.leaf);
    }

    template <typename Fill, typename Tally>
    Block makeBlock(std::size_t worker, const glm::ivec3& corner, int firstSlice, const Fill& fill,
                    const Tally& tally) const {
        alignas(64) std::array<Value, kBlockVoxels> values;
        const glm::ivec3 size = sizeOf(corner);
        const bool whole = isWhole(size);
        if (!whole) values.fill(Value{});
        fill(corner - glm::ivec3(0, 0, firstSlice), size, values.data());
        const bool uniform = whole && isUniform(values.data());
        tally(worker, size, values.data());
        if (uniform) return {nullptr, values[0], values[0]};

        std::unique_ptr<Leaf> leaf = leafAt(corner, size);
        expectPieces(sizeof values);
        leaf->allocate();
        std::copy(values.begin(), values.end(), leaf->buffer().data());
        if constexpr (kHasCodes) {
            const CodeLeaf described = describeLeaf(*leaf);
            return {std::move(leaf), described.lowest, described.highest};
        } else {
            return {std::move(leaf), Value{}, Value{}};
        }
    }

    Block& madeAt(int x, int y, int z) {
        return made_[(std::size_t(z % kNode) * std::size_t(blocks_.y) + std::size_t(y)) *
                         std::size_t(blocks_.x) +
                     std::size_t(x)];
    }

    // Adds a row of nodes with its blocks to the tree.
    void hangInRow(int nodeZ) {
        const glm::ivec2 nodes = (glm::ivec2(blocks_) + (kNode - 1)) / kNode;
        std::vector<std::unique_ptr<Lower>> made(std::size_t(nodes.x) * std::size_t(nodes.y));
        std::vector<std::vector<CodeLeaf>> leaves(made.size());
        parallelFor(made.size(), [&](std::size_t n) {
            const glm::ivec3 first(int(n) % nodes.x * kNode, int(n) / nodes.x * kNode,
                                   nodeZ * kNode);
            made[n] = makeNode(first, leaves[n]);
        });
        for (std::size_t n = 0; n < made.size(); ++n) {
            leaves_.push_back(std::move(leaves[n]));
            hangIn(std::move(made[n]), tree_);
        }
    }

    std::unique_ptr<Lower> makeNode(const glm::ivec3& first, std::vector<CodeLeaf>& leaves) {
        auto node = std::make_unique<Lower>(
            openvdb::Coord(first.x * kBlock, first.y * kBlock, first.z * kBlock),
            tree_.background(), /*active=*/false);
        const glm::ivec3 last = glm::min(first + kNode, blocks_);
        for (int x = first.x; x < last.x; ++x) {
            for (int y = first.y; y < last.y; ++y) {
                for (int z = first.z; z < last.z; ++z) {
                    Block& block = madeAt(x, y, z);
                    const openvdb::Coord corner(x * kBlock, y * kBlock, z * kBlock);
                    if (!block.leaf) {
                        node->addTile(Lower::coordToOffset(corner), block.low, true);
                        continue;
                    }
                    if constexpr (kHasCodes)
                        leaves.push_back({block.leaf.get(), corner, block.low, block.high});
                    node->addChild(block.leaf.release());
                }
            }
        }
        return node;
    }

    glm::ivec3 dims_;
    glm::ivec3 blocks_;
    std::size_t workers_;
    Tree& tree_;
    std::vector<Block> made_;                    // [z % kNode][y][x]
    std::vector<std::vector<CodeLeaf>> leaves_;  // per node, so that none moves twice
};

}  // namespace deltasplat
