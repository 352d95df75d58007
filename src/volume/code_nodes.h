// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Coord.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "volume/code_tree.h"

namespace deltasplat {

/// Where an active tile lies.
struct TilePlace {
    openvdb::Coord origin;
    openvdb::Index level;  ///< 1: of 8^3 voxels, 2: of 128^3, 3: of 4096^3

    std::uint64_t voxels() const { return level == 1 ? 512 : level == 2 ? 1u << 21 : 1ull << 36; }
};

/// Hangs a node of 128^3 voxels into a tree that has none there.
template <typename Tree>
void hangIn(std::unique_ptr<typename Tree::RootNodeType::ChildNodeType::ChildNodeType> node,
            Tree& tree) {
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    Upper* upper = tree.template probeNode<Upper>(node->origin());
    if (!upper) {
        upper = new Upper(node->origin(), tree.background(), /*active=*/false);
        tree.root().addChild(upper);
    }
    upper->addChild(node.release());
}

/// Adds leaves without room for codes, whose voxels are inactive, and active tiles, on all threads.
/// @param leaves  where each leaf's first voxel lies; those of one node of 128^3 voxels follow each
///                other
/// @param tiles   likewise
/// @param codes   of the tiles
/// @param tree    empty
/// @return the leaves
std::vector<CodeTree::Leaf*> addNodes(const std::vector<openvdb::Coord>& leaves,
                                      const std::vector<TilePlace>& tiles,
                                      const std::vector<Code>& codes, CodeTree::Tree& tree);

}  // namespace deltasplat
