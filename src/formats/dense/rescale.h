// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "formats/dense/dense_source.h"
#include "volume/grid_values.h"
#include "volume/value_cast.h"

namespace deltasplat {

/// Does the same as OpenVDB's changeBackground and pruneInactive, without its library.
template <typename Tree>
void settleBackground(Tree& tree, const typename Tree::ValueType& background) {
    openvdb::tree::NodeManager<Tree> all(tree);
    all.foreachTopDown(openvdb::tools::ChangeBackgroundOp<Tree>(tree, background));
    openvdb::tree::NodeManager<Tree, Tree::DEPTH - 2> inner(tree);
    inner.foreachBottomUp(openvdb::tools::InactivePruneOp<Tree>(tree));
}

/// Returns a test for a value to drop, as the grid's type holds it; NaN matches NaN.
template <typename Value>
auto dropTest(double dropped) {
    return [dropped, same = valueAs<Value>(dropped)](Value value) {
        return std::isnan(dropped) ? double(value) != double(value) : value == same;
    };
}

/// Returns the least active value other than `dropped`, or 0 without any.
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

/// Makes voxels of value `dropped` inactive, and gives all inactive voxels a new background.
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

/// value = slope * stored + intercept
struct Rescale {
    double slope = 1;
    double intercept = 0;
    bool isIdentity() const { return slope == 1 && intercept == 0; }
};

/// Returns the type of rescaled values: float32 for at most 16 bits and float32, else float64.
RawType rescaledType(RawType type);

/// Returns an integer type for the rescaled range; nothing if values become real or too large.
std::optional<RawType> rescaledWholeType(double least, double most, const Rescale& rescale);

/// Rescales `count` values of `type` to `toType` in native byte order. Integers saturate.
void rescaleValues(const std::byte* from, std::size_t count, RawType type, bool bigEndian,
                   const Rescale& rescale, RawType toType, std::byte* to);

/// Returns the source with rescaled values, or itself for the identity.
/// @param type  of the new values; empty: rescaledType
DenseSource rescaled(DenseSource source, const Rescale& rescale, std::optional<RawType> type = {});

}  // namespace deltasplat
