// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/NodeManager.h>

#include <type_traits>

#include "volume/value_cast.h"

namespace deltasplat {

namespace prune {

template <typename Node>
bool isUniform(const Node& node, typename Node::ValueType& value, bool& isActive) {
    if (!node.getValueMask().isConstant(isActive)) return false;
    const auto valueAt = [&](openvdb::Index n) {
        if constexpr (Node::LEVEL == 0) {
            return node.getValue(n);
        } else {
            return node.getTable()[n].getValue();
        }
    };
    if constexpr (Node::LEVEL > 0) {
        if (!node.getChildMask().isOff()) return false;
    }
    value = valueAt(0);
    for (openvdb::Index n = 1; n < Node::NUM_VALUES; ++n) {
        if (!haveSameBits(valueAt(n), value)) return false;
    }
    return true;
}

// Called by OpenVDB for every node, children before their parents.
template <typename Tree>
struct PruneNode {
    using Value = typename Tree::ValueType;

    template <typename Node>
    void operator()(Node& node) const {
        if constexpr (Node::LEVEL > 0) {
            Value value{};
            bool isActive = false;
            for (auto child = node.beginChildOn(); child; ++child) {
                if (!isUniform(*child, value, isActive)) continue;
                if constexpr (std::is_same_v<Node, typename Tree::RootNodeType>) {
                    node.addTile(child.getCoord(), value, isActive);
                } else {
                    node.addTile(child.pos(), value, isActive);
                }
            }
        }
    }
};

}  // namespace prune

/// Makes tiles of nodes whose values and active states are all the same, bit for bit. OpenVDB's
/// prune, asked for no tolerance, takes 0 and -0 for equal, NaN for anything, and whole numbers
/// that lie more than half their type's range apart as well.
template <typename Tree>
void pruneSameBits(Tree& tree) {
    tree.clearAllAccessors();
    // Nodes above leaves: those prune the leaves.
    openvdb::tree::NodeManager<Tree, Tree::DEPTH - 2> nodes(tree);
    nodes.foreachBottomUp(prune::PruneNode<Tree>());
}

}  // namespace deltasplat
