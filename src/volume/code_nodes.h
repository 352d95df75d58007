// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Coord.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "volume/code_tree.h"

namespace deltasplat {

struct TilePlace {
    openvdb::Coord origin;
    openvdb::Index level;  ///< 1: 8^3 voxels, 2: 128^3, 3: 4096^3

    std::uint64_t voxels() const { return level == 1 ? 512 : level == 2 ? 1u << 21 : 1ull << 36; }
};

/// Adds a node of 128^3 voxels to a tree that has none at its place.
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

/// Adds leaves with inactive voxels and no room for codes, and active tiles, on all threads.
/// @param leaves  places of first voxels; leaves of one 128^3 node are neighbours in the list
/// @param tiles   places of the tiles, in the same order
/// @param codes   of the tiles
/// @param tree    empty
std::vector<CodeTree::Leaf*> addNodes(const std::vector<openvdb::Coord>& leaves,
                                      const std::vector<TilePlace>& tiles,
                                      const std::vector<Code>& codes, CodeTree::Tree& tree);

}  // namespace deltasplat
