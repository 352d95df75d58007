// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/value_facts.h"

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "formats/raw/raw_load.h"
#include "volume/grid_values.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

template <typename T>
bool within(const ValueFacts& facts) {
    // What is whole is at most the largest if it is below the power of two that follows.
    return facts.whole && facts.doubleError == 0 &&
           facts.min >= double(std::numeric_limits<T>::min()) &&
           facts.max < std::ldexp(1.0, std::numeric_limits<T>::digits);
}

// How the values of a tree are added.
struct Adding {
    bool inactiveOnly = false;  // without active voxels of leaves
    bool isUnsigned = false;    // int64 has the bits of uint64

    template <typename T>
    void add(T value, ValueFacts& facts) const {
        if constexpr (std::is_same_v<T, std::int64_t>)
            if (isUnsigned) return facts.add(std::uint64_t(value));
        facts.add(value);
    }
    template <typename Leaf>
    void addLeaf(const Leaf& leaf, ValueFacts& facts) const {
        if (inactiveOnly) {
            for (auto voxel = leaf.cbeginValueOff(); voxel; ++voxel) add(*voxel, facts);
        } else {
            for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) add(leaf.getValue(i), facts);
        }
    }
};

template <typename Tree>
ValueFacts factsOfTree(const Tree& tree, const Adding& adding) {
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<ValueFacts> parts(leaves.size() / kLeafRun + 1);
    forLeafRuns(leaves.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) adding.addLeaf(*leaves[i], parts[run]);
    });

    ValueFacts whole;
    adding.add(tree.background(), whole);
    for (const ValueFacts& part : parts) whole.append(part);
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) adding.add(*tile, whole);
    return whole;
}

ValueFacts factsOfCodes(const Volume& volume) {
    ValueFacts facts;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] != 0) facts.add(volume.codeBook.valueOf(Code(code)));
    }
    if (volume.hasBackground) facts.add(volume.background);
    return facts;
}

}  // namespace

void ValueFacts::append(const ValueFacts& other) {
    if (!other.any) return;
    min = any ? std::min(min, other.min) : other.min;
    max = any ? std::max(max, other.max) : other.max;
    any = true;
    whole = whole && other.whole;
    floats = floats && other.floats;
    ints = ints && other.ints;
    unsignedInts = unsignedInts && other.unsignedInts;
    doubleError = std::max(doubleError, other.doubleError);
}

bool ValueFacts::fit(RawType type) const {
    return withRawType(type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_same_v<T, std::int64_t>) return ints;
        if constexpr (std::is_same_v<T, std::uint64_t>) return unsignedInts;
        if constexpr (std::is_integral_v<T>) return within<T>(*this);
        return doubleError == 0 && (floats || std::is_same_v<T, double>);
    });
}

ValueFacts factsOf(const Volume& volume) {
    if (!volume.source) return factsOfCodes(volume);
    // Which exact codes there are has been counted.
    const bool isExact = volume.codeBook.isExact();
    ValueFacts facts = isExact ? factsOfCodes(volume) : ValueFacts();
    const Adding adding{isExact, holdsUnsigned(volume)};
    volume.source->grid.apply<ScalarTrees>(
        [&](const auto& tree) { facts.append(factsOfTree(tree, adding)); });
    return facts;
}

}  // namespace deltasplat
