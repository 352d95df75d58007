// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "deltasplat/threads.h"
#include "parallel.h"

namespace deltasplat {

/// Builds the OpenVDB tree of a dense volume, one layer of 8 slices at a time. Every voxel of the
/// volume is active; a whole block of one value becomes a tile. Deterministic whatever the thread
/// count.
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
          blocks_((glm::ivec2(dims) + (kBlock - 1)) / kBlock),
          strips_(std::clamp(threadCount(), 1, blocks_.y)),
          tree_(tree) {}

    /// How many parts of a layer are worked on at the same time, each by one thread.
    int strips() const { return strips_; }

    /// Adds the slices firstSlice .. firstSlice + 7, or to the last; firstSlice is a multiple of 8.
    /// @param fill   fill(corner, size, values) writes the values of the block at voxel corner
    ///               (x, y) into values[512], in leaf order; called from all threads
    /// @param tally  tally(strip, size, values, uniform) hears of every block after it is filled;
    ///               `uniform`: it is whole and has one value
    template <typename Fill, typename Tally>
    void addLayer(int firstSlice, const Fill& fill, const Tally& tally) {
        std::vector<Block> layer(std::size_t(blocks_.x) * std::size_t(blocks_.y));
        parallelFor(std::size_t(strips_), [&](std::size_t strip) {
            for (int y = int(strip); y < blocks_.y; y += strips_) {
                for (int x = 0; x < blocks_.x; ++x) {
                    const glm::ivec3 corner(x * kBlock, y * kBlock, firstSlice);
                    Block& block = layer[std::size_t(y) * std::size_t(blocks_.x) + std::size_t(x)];
                    block = makeBlock(strip, corner, fill, tally);
                }
            }
        });
        hangIn(layer, firstSlice);
    }

    /// Returns the most bytes that one layer can add to the tree.
    double worstLayerBytes() const {
        const double blocks = double(blocks_.x) * blocks_.y;
        return blocks * (sizeof(Leaf) + kBlockVoxels * sizeof(Value) + sizeof(Block));
    }

  private:
    struct Block {
        std::unique_ptr<Leaf> leaf;  // empty: a tile of `value`
        Value value{};
    };

    static bool isUniform(const Value* values) {
        // All neighbours equal: a comparison that libraries do with whole vectors.
        const auto* bytes = reinterpret_cast<const std::byte*>(values);
        return std::memcmp(bytes, bytes + sizeof(Value), (kBlockVoxels - 1) * sizeof(Value)) == 0;
    }

    static void deactivateOutside(Leaf& leaf, const glm::ivec3& size) {
        for (int x = 0; x < kBlock; ++x) {
            for (int y = 0; y < kBlock; ++y) {
                for (int z = 0; z < kBlock; ++z) {
                    const bool inside = x < size.x && y < size.y && z < size.z;
                    if (!inside) leaf.setValueOff(openvdb::Index(x * 64 + y * 8 + z), Value{});
                }
            }
        }
    }

    template <typename Fill, typename Tally>
    Block makeBlock(std::size_t strip, const glm::ivec3& corner, const Fill& fill,
                    const Tally& tally) const {
        alignas(64) std::array<Value, kBlockVoxels> values;
        const glm::ivec3 size = glm::min(dims_ - corner, glm::ivec3(kBlock));
        const bool whole = size == glm::ivec3(kBlock);
        if (!whole) values.fill(Value{});
        fill(glm::ivec2(corner), size, values.data());
        const bool uniform = whole && isUniform(values.data());
        tally(strip, size, values.data(), uniform);
        if (uniform) return {nullptr, values[0]};

        auto leaf =
            std::make_unique<Leaf>(openvdb::Coord(corner.x, corner.y, corner.z), Value{}, true);
        std::copy(values.begin(), values.end(), leaf->buffer().data());
        if (!whole) deactivateOutside(*leaf, size);
        return {std::move(leaf), Value{}};
    }

    // The tree is not made for several writers; hanging finished blocks in is the small part.
    void hangIn(std::vector<Block>& layer, int firstSlice) {
        openvdb::tree::ValueAccessor<Tree> accessor(tree_);
        for (int y = 0; y < blocks_.y; ++y) {
            for (int x = 0; x < blocks_.x; ++x) {
                Block& block = layer[std::size_t(y) * std::size_t(blocks_.x) + std::size_t(x)];
                if (block.leaf) {
                    accessor.addLeaf(block.leaf.release());
                } else {
                    const openvdb::Coord corner(x * kBlock, y * kBlock, firstSlice);
                    accessor.addTile(1, corner, block.value, true);
                }
            }
        }
    }

    glm::ivec3 dims_;
    glm::ivec2 blocks_;
    int strips_;
    Tree& tree_;
};

}  // namespace deltasplat
