// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/restored_grid.h"

#include <openvdb/tree/NodeManager.h>
#include <string_view>
#include <type_traits>
#include <vector>

#include "deltasplat/error.h"
#include "volume/tree_from_codes.h"
#include "volume/value_cast.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

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

// OpenVDB calls this for every node, children before parents.
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

/// Makes tiles of nodes whose values and states are equal bit for bit. OpenVDB's prune also equates
/// 0 with -0, NaN with anything, and whole numbers more than half their type's range apart.
template <typename Tree>
void pruneSameBits(Tree& tree) {
    tree.clearAllAccessors();
    // Nodes above leaves, because these prune the leaves.
    openvdb::tree::NodeManager<Tree, Tree::DEPTH - 2> nodes(tree);
    nodes.foreachBottomUp(prune::PruneNode<Tree>());
}

}  // namespace

namespace {

// Sets the values of inactive voxels other than the background, and prunes the tree.
template <typename Tree>
void setInactive(const CodeTree::Tree& inactive, const std::vector<double>& values, Tree& tree) {
    openvdb::tree::ValueAccessor<Tree> accessor(tree);
    const auto valueOf = [&](Code number) {
        return valueAs<typename Tree::ValueType>(values[number]);
    };
    for (auto leaf = inactive.cbeginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
            accessor.setValueOff(voxel.getCoord(), valueOf(*voxel));
    }
    auto tile = inactive.cbeginValueOn();
    tile.setMaxDepth(CodeTree::Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) accessor.addTile(1, tile.getCoord(), valueOf(*tile), false);
    pruneSameBits(tree);
}

std::shared_ptr<openvdb::TreeBase> restoredTree(const DeltaHeader& header,
                                                const DecodedDeltas& decoded) {
    std::shared_ptr<openvdb::TreeBase> restored;
    applyType(ScalarTrees(), header.sourceTree, [&]<typename Tree>(std::type_identity<Tree>) {
        auto tree = treeFromCodes<Tree>(decoded.codes->tree(), header.book,
                                        valueAs<typename Tree::ValueType>(header.background));
        setInactive(decoded.inactive->tree(), header.inactiveValues, *tree);
        restored = std::move(tree);
    });
    return restored;
}

// Returns the source's own metadata under their original names.
VdbMetadata sourceMetadata(const VdbMetadata& stored) {
    const std::string_view prefix = kSourcePrefix;
    VdbMetadata own;
    for (const auto& [name, entry] : stored.entries()) {
        if (name.starts_with(prefix) && name.size() > prefix.size())
            own.insert(name.substr(prefix.size()), entry);
    }
    return own;
}

// Adds the source's metadata and transform to a tree.
TreeGrid dressed(std::shared_ptr<openvdb::TreeBase> tree, const TreeGrid& deltas,
                 const DeltaHeader& header, const glm::dmat4& worldFromIndex) {
    return {std::move(tree), sourceMetadata(deltas.metadata),
            makeMapOfType(header.sourceMap, worldFromIndex)};
}

}  // namespace

TreeGrid restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex) {
    return dressed(restoredTree(header, decoded), deltas, header, worldFromIndex);
}

TreeGrid restoreGrid(const DeltaHeader& header, const DecodedValues& decoded,
                     const TreeGrid& deltas, const glm::dmat4& worldFromIndex) {
    TreeGrid grid = header.sourceTree.empty()
                        ? TreeGrid{decoded.values, {}, makeMapIfAny(worldFromIndex)}
                        : dressed(decoded.values, deltas, header, worldFromIndex);
    if (header.sourceTree.empty())
        grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, deltas.name());
    grid.apply<ExactTrees>(
        [&](auto& tree) { setInactive(decoded.inactive->tree(), header.inactiveValues, tree); });
    return grid;
}

void requireActiveCount(std::uint64_t active, const DeltaHeader& header, const std::string& where) {
    if (active == header.active) return;
    throw Error(ErrorCode::kInput, where, std::to_string(active) + " active voxels",
                std::to_string(header.active) + ", as \"delta_active\" says");
}

}  // namespace deltasplat
