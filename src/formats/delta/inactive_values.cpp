// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/inactive_values.h"

#include <cstdint>
#include <type_traits>

#include "volume/book_encoder.h"
#include "volume/distinct_values.h"
#include "volume/grid_values.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

// Calls use(iterator) for all inactive voxels and tiles that do not hold the background.
template <typename Tree, typename Use>
void forInactive(const Tree& tree, const Use& use) {
    const auto background = double(tree.background());
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        if (leaf->isDense()) continue;
        for (auto voxel = leaf->cbeginValueOff(); voxel; ++voxel) {
            if (!haveSameBits(double(*voxel), background))
                use(voxel.getCoord(), double(*voxel), nullptr);
        }
    }
    auto tile = tree.cbeginValueOff();
    tile.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (haveSameBits(double(*tile), background)) continue;
        const openvdb::CoordBBox box = tile.getBoundingBox();
        use(box.min(), double(*tile), &box);
    }
}

// Whether a grid has whole numbers that no double holds, where they are not active.
template <typename Tree>
bool hasRounded(const Tree& tree) {
    using T = typename Tree::ValueType;
    if constexpr (std::is_same_v<T, std::int64_t>) {
        const auto isRounded = [](T value) { return valueAs<T>(double(value)) != value; };
        if (isRounded(tree.background())) return true;
        for (auto value = tree.cbeginValueOff(); value; ++value) {
            if (isRounded(*value)) return true;
        }
    }
    return false;
}

template <typename Tree>
InactiveValues find(const Tree& tree) {
    InactiveValues found;
    found.rounded = hasRounded(tree);
    DistinctValues distinct;
    forInactive(tree,
                [&](const auto&, double value, const openvdb::CoordBBox*) { distinct.add(value); });
    found.tooMany = distinct.tooMany();
    if (!found.tooMany) found.values = distinct.sorted();
    if (found.values.empty()) return found;

    const BookEncoder encoder(CodeBook::ofTable(found.values));
    auto numbers = std::make_shared<CodeTree>();
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(numbers->tree());
    forInactive(tree, [&](const openvdb::Coord& at, double value, const openvdb::CoordBBox* box) {
        if (box) {
            numbers->tree().fill(*box, encoder(value), true);
        } else {
            accessor.setValueOn(at, encoder(value));
        }
    });
    found.numbers = std::move(numbers);
    return found;
}

}  // namespace

double backgroundOf(const TreeGrid& grid) {
    double background = 0;
    grid.apply<ScalarTrees>([&](const auto& tree) { background = double(tree.background()); });
    return background;
}

InactiveValues findInactiveValues(const TreeGrid& grid) {
    InactiveValues found;
    grid.apply<ScalarTrees>([&](const auto& tree) { found = find(tree); });
    return found;
}

}  // namespace deltasplat
