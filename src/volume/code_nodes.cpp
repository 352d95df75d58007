// SPDX-License-Identifier: Apache-2.0
#include "volume/code_nodes.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"

namespace deltasplat {
namespace {

using Lower = CodeTree::Tree::RootNodeType::ChildNodeType::ChildNodeType;

struct Part {
    std::size_t begin = 0;
    std::size_t end = 0;
};

// A new node of 128^3 voxels and its contents.
struct LowerParts {
    Part leaves;
    Part tiles;
    std::unique_ptr<Lower> node;
};

using LowerMap = std::map<openvdb::Coord, LowerParts>;

openvdb::Coord lowerOrigin(const openvdb::Coord& place) {
    return place & ~(Lower::DIM - 1);
}

// Notes which part of a list goes into which node. originOf(i): place of item i, or nothing.
template <typename OriginOf>
void addParts(std::size_t count, const OriginOf& originOf, Part LowerParts::*which,
              LowerMap& nodes) {
    Part* part = nullptr;
    openvdb::Coord node;
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<openvdb::Coord> origin = originOf(i);
        if (!origin) {
            part = nullptr;
            continue;
        }
        if (!part || lowerOrigin(*origin) != node) {
            node = lowerOrigin(*origin);
            part = &(nodes[node].*which);
            part->begin = i;
        }
        part->end = i + 1;
    }
}

}  // namespace

std::vector<CodeTree::Leaf*> addNodes(const std::vector<openvdb::Coord>& leaves,
                                      const std::vector<TilePlace>& tiles,
                                      const std::vector<Code>& codes, CodeTree::Tree& tree) {
    LowerMap parts;
    addParts(
        leaves.size(), [&](std::size_t i) { return std::optional(leaves[i]); }, &LowerParts::leaves,
        parts);
    addParts(
        tiles.size(),
        [&](std::size_t i) {
            return tiles[i].level == 1 ? std::optional(tiles[i].origin) : std::nullopt;
        },
        &LowerParts::tiles, parts);
    std::vector<LowerMap::value_type*> nodes;
    for (auto& entry : parts) nodes.push_back(&entry);
    std::vector<CodeTree::Leaf*> added(leaves.size());
    parallelFor(nodes.size(), [&](std::size_t n) {
        auto& [origin, made] = *nodes[n];
        expectPieces(sizeof(Lower) +
                     (made.leaves.end - made.leaves.begin) * sizeof(CodeTree::Leaf));
        made.node = std::make_unique<Lower>(origin, Code{0}, /*active=*/false);
        for (std::size_t i = made.leaves.begin; i < made.leaves.end; ++i) {
            // The node owns the leaf from here on.
            added[i] = new CodeTree::Leaf(openvdb::PartialCreate(), leaves[i]);
            made.node->addChild(added[i]);
        }
        for (std::size_t i = made.tiles.begin; i < made.tiles.end; ++i) {
            made.node->addTile(Lower::coordToOffset(tiles[i].origin), codes[i], true);
        }
    });
    for (auto& [origin, made] : parts) hangIn(std::move(made.node), tree);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].level > 1) tree.addTile(tiles[i].level, tiles[i].origin, codes[i], true);
    }
    return added;
}

}  // namespace deltasplat
