// SPDX-License-Identifier: Apache-2.0
#include "volume/keep_voxels.h"

#include <openvdb/tree/ValueAccessor.h>

#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

using Leaf = CodeTree::Leaf;

struct Block {
    openvdb::Coord origin;
    const Leaf* leaf = nullptr;  // null: all voxels have `code`
    Code code = 0;
};

constexpr double kBlockBytes = leafBytes<Leaf>() + sizeof(Block);

IndexBox boxAt(const openvdb::Coord& origin, int width) {
    const glm::ivec3 first(origin.x(), origin.y(), origin.z());
    return {first, first + (width - 1)};
}

// Adds tiles that are kept whole to a tree, and lists the blocks of tiles that are kept in part.
class TileSplitter {
  public:
    TileSplitter(const CutRegion& region, CodeTree::Tree& tree, std::vector<Block>& blocks)
        : region_(region), accessor_(tree), blocks_(blocks) {}

    /// @param level  of the tile in the tree: 1, 2 or 3
    void add(const openvdb::Coord& origin, int level, Code code) {
        constexpr int kWidths[] = {1, 8, 128, 4096};
        const Kept kept = region_.keptOf(boxAt(origin, kWidths[level]));
        if (kept == Kept::kNone) return;
        if (kept == Kept::kAll) return accessor_.addTile(openvdb::Index(level), origin, code, true);
        if (level == 1) return addBlock(origin, code);
        const int step = kWidths[level - 1];
        for (int x = 0; x < kWidths[level]; x += step) {
            for (int y = 0; y < kWidths[level]; y += step) {
                for (int z = 0; z < kWidths[level]; z += step)
                    add(origin.offsetBy(x, y, z), level - 1, code);
            }
        }
    }

  private:
    void addBlock(const openvdb::Coord& origin, Code code) {
        // Asks again whenever the list doubles.
        if (blocks_.size() == blocks_.capacity())
            requireMemory("cut", 2 * kBlockBytes * double(blocks_.size()));
        blocks_.push_back({origin, nullptr, code});
    }

    const CutRegion& region_;
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor_;
    std::vector<Block>& blocks_;
};

// Returns a block's kept voxels, or null.
std::unique_ptr<Leaf> keptLeaf(const Block& block, const CutRegion& region) {
    Leaf::NodeMaskType voxels(true);
    if (block.leaf) voxels = block.leaf->valueMask();
    if (region.keptOf(boxAt(block.origin, Leaf::DIM)) != Kept::kAll)
        region.keepIn(block.origin, voxels);
    if (voxels.isOff()) return nullptr;
    auto leaf = std::make_unique<Leaf>(block.origin, Code(0), false);
    for (auto on = voxels.beginOn(); on; ++on)
        leaf->setValueOn(on.pos(), block.leaf ? block.leaf->getValue(on.pos()) : block.code);
    return leaf;
}

std::vector<Block> listBlocks(const CodeTree& codes, const CutRegion& region,
                              CodeTree::Tree& tree) {
    std::vector<Block> blocks;
    std::vector<const Leaf*> leaves;
    for (const CodeLeaf& one : *codes.leaves()) {
        if (region.keptOf(boxAt(one.origin, Leaf::DIM)) == Kept::kNone) continue;
        blocks.push_back({one.origin, one.leaf, 0});
        leaves.push_back(one.leaf);
    }
    requireMemory("cut", double(blocks.size()) * kBlockBytes);
    codes.readLeaves(leaves);
    TileSplitter splitter(region, tree, blocks);
    forActiveTiles(codes.nodes(), [&](const auto& tile) {
        splitter.add(tile.getCoord(), int(tile.getLevel()), *tile);
    });
    return blocks;
}

}  // namespace

std::shared_ptr<CodeTree> keepVoxels(const CodeTree& codes, const CutRegion& region) {
    auto result = std::make_shared<CodeTree>();
    const std::vector<Block> blocks = listBlocks(codes, region, result->tree());
    std::vector<std::unique_ptr<Leaf>> leaves(blocks.size());
    parallelForChunks(blocks.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) leaves[i] = keptLeaf(blocks[i], region);
    });
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(result->tree());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!leaves[i]) continue;
        if (!blocks[i].leaf && leaves[i]->isDense()) {
            accessor.addTile(1, blocks[i].origin, blocks[i].code, true);
        } else {
            accessor.addLeaf(leaves[i].release());
        }
    }
    return result;
}

}  // namespace deltasplat
