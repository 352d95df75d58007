// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"

namespace deltasplat {

/// Makes a tree of the codes' values, with the same active voxels and tiles. Multi-threaded.
template <typename Tree>
typename Tree::Ptr treeFromCodes(const CodeTree::Tree& codes, const CodeBook& book,
                                 typename Tree::ValueType background) {
    using Value = typename Tree::ValueType;
    auto tree = typename Tree::Ptr(new Tree(codes, background, openvdb::TopologyCopy()));
    const auto valueOf = [&](Code code) { return valueAs<Value>(book.valueOf(code)); };
    if constexpr (!std::is_same_v<Tree, openvdb::MaskTree>) {
        std::vector<const CodeTree::Leaf*> sources;
        std::vector<typename Tree::LeafNodeType*> targets;
        codes.getNodes(sources);
        tree->getNodes(targets);
        forLeafRuns(sources.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Code* from = sources[i]->buffer().data();
                for (auto on = sources[i]->valueMask().beginOn(); on; ++on)
                    targets[i]->setValueOnly(on.pos(), valueOf(from[on.pos()]));
            }
        });
    }
    // In a mask only tiles have values.
    forActiveTiles(
        *tree, [&](const auto& tile) { tile.setValue(valueOf(codes.getValue(tile.getCoord()))); });
    return tree;
}

}  // namespace deltasplat
