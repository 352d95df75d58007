// SPDX-License-Identifier: Apache-2.0
#include "convert/half_exact.h"

#include <atomic>
#include <type_traits>
#include <vector>

#include "ingest/grids/grid_values.h"
#include "ingest/grids/tree_types.h"
#include "ingest/values/value_cast.h"

namespace deltasplat {
namespace {

template <typename T>
bool isHalf(T value) {
    const auto back = T(float(openvdb::math::half(float(value))));
    return back == value || value != value;
}

template <typename T>
bool areHalves(const Volume& volume, double background) {
    if (!isHalf(valueAs<T>(background))) return false;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] > 0 && !isHalf(valueAs<T>(volume.codeBook.valueOf(Code(code)))))
            return false;
    }
    return true;
}

template <typename Leaf>
bool isHalfLeaf(const Leaf& leaf, bool inactiveOnly) {
    if (inactiveOnly) {
        for (auto voxel = leaf.cbeginValueOff(); voxel; ++voxel) {
            if (!isHalf(*voxel)) return false;
        }
        return true;
    }
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        if (!isHalf(leaf.getValue(i))) return false;
    }
    return true;
}

// @param inactiveOnly  leaves active voxels of leaves out
template <typename Tree>
bool survives(const Tree& tree, bool inactiveOnly) {
    // Background and inactive values are stored as halves too.
    if (!isHalf(tree.background())) return false;
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (!isHalf(*tile)) return false;
    }
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::atomic<bool> all = true;
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && all; ++i) {
            if (!isHalfLeaf(*leaves[i], inactiveOnly)) all = false;
        }
    });
    return all;
}

}  // namespace

bool survivesHalf(const TreeGrid& grid, const Volume* volume) {
    bool all = false;
    grid.apply<TreeTypes<openvdb::FloatTree, openvdb::DoubleTree>>([&](const auto& tree) {
        using Value = typename std::decay_t<decltype(tree)>::ValueType;
        const bool isCounted = volume && volume->codeBook.isExact();
        all = (!isCounted || areHalves<Value>(*volume, double(tree.background()))) &&
              survives(tree, isCounted);
    });
    return all;
}

bool survivesHalf(const Volume& volume, const std::string& type, double background) {
    if (type == "float") return areHalves<float>(volume, background);
    return type == "double" && areHalves<double>(volume, background);
}

}  // namespace deltasplat
