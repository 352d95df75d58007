// SPDX-License-Identifier: Apache-2.0
#include "ingest/codes/code_nodes.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>

#include "heap_growth.h"
#include "parallel.h"

namespace deltasplat {
namespace {

using Upper = CodeTree::Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;

// The part [begin, end) of a list.
struct Part {
    std::size_t begin = 0;
    std::size_t end = 0;
};

// A node of 128^3 voxels that is made, and what goes into it.
struct LowerParts {
    Part leaves;
    Part tiles;
    std::unique_ptr<Lower> node;
};

using LowerMap = std::map<openvdb::Coord, LowerParts>;

openvdb::Coord lowerOrigin(const openvdb::Coord& place) {
    return place & ~(Lower::DIM - 1);
}

// Notes which parts of a list go into which nodes.
template <typename OriginOf>
void addParts(std::size_t count, const OriginOf& originOf, Part LowerParts::*which,
              LowerMap& nodes) {
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        const openvdb::Coord origin = lowerOrigin(originOf(begin));
        for (end = begin + 1; end < count && lowerOrigin(originOf(end)) == origin;) ++end;
        nodes[origin].*which = {begin, end};
    }
}

}  // namespace

std::vector<CodeTree::Leaf*> addNodes(const std::vector<openvdb::Coord>& leaves,
                                      const std::vector<TilePlace>& tiles,
                                      const std::vector<Code>& codes, CodeTree::Tree& tree) {
    std::vector<std::size_t> small;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].level == 1) small.push_back(i);
    }
    LowerMap parts;
    addParts(
        leaves.size(), [&](std::size_t i) { return leaves[i]; }, &LowerParts::leaves, parts);
    addParts(
        small.size(), [&](std::size_t i) { return tiles[small[i]].origin; }, &LowerParts::tiles,
        parts);
    std::vector<LowerMap::value_type*> nodes;
    for (auto& entry : parts) nodes.push_back(&entry);
    std::vector<CodeTree::Leaf*> added(leaves.size());
    parallelFor(nodes.size(), [&](std::size_t n) {
        auto& [origin, made] = *nodes[n];
        expectPieces(sizeof(Lower) +
                     (made.leaves.end - made.leaves.begin) * sizeof(CodeTree::Leaf));
        made.node = std::make_unique<Lower>(origin, Code{0}, /*active=*/false);
        for (std::size_t i = made.leaves.begin; i < made.leaves.end; ++i) {
            // The node's from here on.
            added[i] = new CodeTree::Leaf(openvdb::PartialCreate(), leaves[i]);
            made.node->addChild(added[i]);
        }
        for (std::size_t i = made.tiles.begin; i < made.tiles.end; ++i) {
            const std::size_t tile = small[i];
            made.node->addTile(Lower::coordToOffset(tiles[tile].origin), codes[tile], true);
        }
    });
    std::map<openvdb::Coord, Upper*> uppers;
    for (auto& [origin, made] : parts) {
        Upper*& upper = uppers[origin & ~(Upper::DIM - 1)];
        if (!upper) {
            upper = new Upper(origin & ~(Upper::DIM - 1), Code{0}, /*active=*/false);
            tree.root().addChild(upper);
        }
        upper->addChild(made.node.release());
    }
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].level > 1) tree.addTile(tiles[i].level, tiles[i].origin, codes[i], true);
    }
    return added;
}

}  // namespace deltasplat
