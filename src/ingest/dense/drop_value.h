// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ingest/grids/grid_values.h"
#include "ingest/values/value_cast.h"

namespace deltasplat {

/// Does what OpenVDB's changeBackground and pruneInactive do, which its library has.
template <typename Tree>
void settleBackground(Tree& tree, const typename Tree::ValueType& background) {
    openvdb::tree::NodeManager<Tree> all(tree);
    all.foreachTopDown(openvdb::tools::ChangeBackgroundOp<Tree>(tree, background));
    openvdb::tree::NodeManager<Tree, Tree::DEPTH - 2> inner(tree);
    inner.foreachBottomUp(openvdb::tools::InactivePruneOp<Tree>(tree));
}

/// Whether a value, as the grid's type has it, is to be dropped; NaN stands for itself.
template <typename Value>
auto dropTest(double dropped) {
    return [dropped, same = valueAs<Value>(dropped)](Value value) {
        return std::isnan(dropped) ? double(value) != double(value) : value == same;
    };
}

/// Returns the least value that stays, 0 if none does.
template <typename Tree>
double leastOther(const Tree& tree, double dropped) {
    const auto isDropped = dropTest<typename Tree::ValueType>(dropped);
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<double> least(leaves.size(), std::numeric_limits<double>::infinity());
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel)
                if (!isDropped(*voxel)) least[i] = std::min(least[i], double(*voxel));
        }
    });
    forActiveTiles(tree, [&](const auto& tile) {
        if (!isDropped(*tile)) least.push_back(double(*tile));
    });
    const auto found = std::min_element(least.begin(), least.end());
    return found == least.end() || std::isinf(*found) ? 0 : *found;
}

/// Makes inactive what has a value, and what is inactive have another.
template <typename Tree>
void dropValue(Tree& tree, double dropped, double newBackground) {
    using Value = typename Tree::ValueType;
    const auto background = valueAs<Value>(newBackground);
    const auto isDropped = dropTest<Value>(dropped);
    std::vector<typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (auto voxel = leaves[i]->beginValueOn(); voxel; ++voxel) {
                if (isDropped(*voxel)) leaves[i]->setValueOff(voxel.pos(), background);
            }
        }
    });
    forActiveTiles(tree, [&](const auto& tile) {
        if (!isDropped(*tile)) return;
        tile.setValue(background);
        tile.setActiveState(false);
    });
    settleBackground(tree, background);
}

}  // namespace deltasplat
