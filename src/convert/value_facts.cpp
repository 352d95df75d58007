// SPDX-License-Identifier: Apache-2.0
#include "convert/value_facts.h"

#include <limits>
#include <vector>

#include "ingest/grid_values.h"
#include "ingest/scalar_grids.h"
#include "ingest/source_grid.h"

namespace deltasplat {
namespace {

template <typename T>
bool within(const ValueFacts& facts) {
    return facts.whole && facts.min >= double(std::numeric_limits<T>::min()) &&
           facts.max <= double(std::numeric_limits<T>::max());
}

template <typename Leaf>
void addLeaf(const Leaf& leaf, ValueFacts& facts) {
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) facts.add(leaf.getValue(i));
}

template <typename Tree>
ValueFacts factsOfTree(const Tree& tree) {
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<ValueFacts> parts(leaves.size() / kLeafRun + 1);
    forLeafRuns(leaves.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) addLeaf(*leaves[i], parts[run]);
    });

    ValueFacts whole;
    whole.add(tree.background());
    for (const ValueFacts& part : parts) whole.append(part);
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) whole.add(*tile);
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
    doubleError = std::max(doubleError, other.doubleError);
}

bool ValueFacts::fit(RawType type) const {
    switch (type) {
        case RawType::kUint8:
            return within<std::uint8_t>(*this);
        case RawType::kInt8:
            return within<std::int8_t>(*this);
        case RawType::kUint16:
            return within<std::uint16_t>(*this);
        case RawType::kInt16:
            return within<std::int16_t>(*this);
        case RawType::kUint32:
            return within<std::uint32_t>(*this);
        case RawType::kInt32:
            return within<std::int32_t>(*this);
        case RawType::kFloat32:
            return floats;
        case RawType::kFloat64:
            break;
    }
    return doubleError == 0;
}

ValueFacts factsOf(const Volume& volume) {
    if (!volume.source) return factsOfCodes(volume);
    ValueFacts facts;
    volume.source->grid->apply<ScalarGrids>(
        [&](const auto& grid) { facts = factsOfTree(grid.constTree()); });
    return facts;
}

}  // namespace deltasplat
