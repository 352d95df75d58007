// SPDX-License-Identifier: Apache-2.0
#include "ingest/code_tree_builder.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>

#include "deltasplat/threads.h"
#include "parallel.h"

namespace deltasplat {
namespace {

using Leaf = CodeTree::Leaf;
constexpr int kBlock = Leaf::DIM;
constexpr int kBlockVoxels = Leaf::SIZE;

bool isUniform(const Code* codes) {
    // Gathering differences without a branch inside lets the compiler use whole vectors.
    unsigned different = 0;
    for (int i = 1; i < kBlockVoxels; ++i) different |= unsigned(codes[i] ^ codes[0]);
    return different == 0;
}

void deactivateOutside(Leaf& leaf, const glm::ivec3& size) {
    for (int x = 0; x < kBlock; ++x) {
        for (int y = 0; y < kBlock; ++y) {
            for (int z = 0; z < kBlock; ++z) {
                const bool inside = x < size.x && y < size.y && z < size.z;
                if (!inside) leaf.setValueOff(openvdb::Index(x * 64 + y * 8 + z), Code{0});
            }
        }
    }
}

}  // namespace

struct CodeTreeBuilder::Block {
    std::unique_ptr<Leaf> leaf;  // empty: a tile of `code`
    Code code = 0;
};

CodeTreeBuilder::CodeTreeBuilder(const glm::ivec3& dims)
    : dims_(dims),
      blocks_((glm::ivec2(dims) + (kBlock - 1)) / kBlock),
      tree_(std::make_shared<CodeTree>()),
      counts_(std::size_t(std::clamp(threadCount(), 1, blocks_.y))) {}

CodeTreeBuilder::Block CodeTreeBuilder::makeBlock(const glm::ivec3& corner, const FillBlock& fill,
                                                  std::uint64_t* counts) const {
    alignas(64) std::array<Code, kBlockVoxels> codes;
    const glm::ivec3 size = glm::min(dims_ - corner, glm::ivec3(kBlock));
    const bool whole = size == glm::ivec3(kBlock);
    if (!whole) codes.fill(0);
    fill(glm::ivec2(corner), glm::ivec2(size), codes.data());
    if (whole && isUniform(codes.data())) {
        counts[codes[0]] += kBlockVoxels;
        return {nullptr, codes[0]};
    }

    auto leaf = std::make_unique<Leaf>(openvdb::Coord(corner.x, corner.y, corner.z), Code{0}, true);
    std::copy(codes.begin(), codes.end(), leaf->buffer().data());
    for (const Code code : codes) ++counts[code];
    if (!whole) {
        deactivateOutside(*leaf, size);
        counts[0] -= std::uint64_t(kBlockVoxels - size.x * size.y * size.z);
    }
    return {std::move(leaf), 0};
}

void CodeTreeBuilder::addLayer(int firstSlice, const FillBlock& fill) {
    std::vector<Block> layer(std::size_t(blocks_.x) * std::size_t(blocks_.y));
    const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(blocks_.x) + x; };
    const int strips = int(counts_.size());
    parallelFor(counts_.size(), [&](std::size_t strip) {
        counts_[strip].resize(kCodeCount);
        for (int y = int(strip); y < blocks_.y; y += strips) {
            for (int x = 0; x < blocks_.x; ++x) {
                const glm::ivec3 corner(x * kBlock, y * kBlock, firstSlice);
                layer[at(x, y)] = makeBlock(corner, fill, counts_[strip].data());
            }
        }
    });

    // The tree is not made for several writers; hanging finished blocks in is the small part.
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(tree_->tree);
    for (int y = 0; y < blocks_.y; ++y) {
        for (int x = 0; x < blocks_.x; ++x) {
            Block& block = layer[at(x, y)];
            if (block.leaf) {
                accessor.addLeaf(block.leaf.release());
            } else {
                const openvdb::Coord corner(x * kBlock, y * kBlock, firstSlice);
                accessor.addTile(1, corner, block.code, true);
            }
        }
    }
}

std::vector<std::uint64_t> CodeTreeBuilder::histogram() const {
    std::vector<std::uint64_t> sum(kCodeCount);
    for (const std::vector<std::uint64_t>& counts : counts_) {
        for (std::size_t code = 0; code < counts.size(); ++code) sum[code] += counts[code];
    }
    return sum;
}

double CodeTreeBuilder::worstLayerBytes() const {
    const double blocks = double(blocks_.x) * blocks_.y;
    return blocks * (sizeof(Leaf) + kBlockVoxels * sizeof(Code) + sizeof(Block));
}

}  // namespace deltasplat
