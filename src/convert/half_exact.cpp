// SPDX-License-Identifier: Apache-2.0
#include "convert/half_exact.h"

#include <openvdb/openvdb.h>

#include <atomic>
#include <vector>

#include "ingest/grid_values.h"

namespace deltasplat {
namespace {

template <typename T>
bool isHalf(T value) {
    const auto back = T(float(openvdb::math::half(float(value))));
    return back == value || value != value;
}

// Active-mask compression stores neither the background nor its negative where a node's inactive
// values are only those: they come back whole. Any other inactive value is stored as a half, and
// may bring the background with it.
template <typename T>
class HalfTest {
  public:
    explicit HalfTest(T background)
        : background_(background), halfBackground_(isHalf(background)) {}

    bool operator()(T value, bool active) const {
        if (active) return isHalf(value);
        return value == background_ || value == -background_ || (halfBackground_ && isHalf(value));
    }

  private:
    T background_;
    bool halfBackground_;
};

template <typename Leaf, typename Test>
bool passes(const Leaf& leaf, const Test& test) {
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        if (!test(leaf.getValue(i), leaf.isValueOn(i))) return false;
    }
    return true;
}

template <typename Tree>
bool survives(const Tree& tree) {
    const HalfTest<typename Tree::ValueType> test(tree.background());
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (!test(*tile, tile.isValueOn())) return false;
    }
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::atomic<bool> all = true;
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && all; ++i) {
            if (!passes(*leaves[i], test)) all = false;
        }
    });
    return all;
}

}  // namespace

bool survivesHalf(const openvdb::GridBase& grid) {
    bool all = false;
    grid.apply<openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid>>(
        [&](const auto& real) { all = survives(real.constTree()); });
    return all;
}

}  // namespace deltasplat
