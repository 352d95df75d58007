// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/drop_background.h"

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "base/memory.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

template <typename Tree>
double mostFrequentOf(const Tree& tree, const CodeBook& book, Code code) {
    std::map<double, std::uint64_t> counts;
    for (auto value = tree.cbeginValueOn(); value; ++value) {
        const auto number = double(*value);
        if (book.codeOf(number) == code) counts[number] += value.getVoxelCount();
    }
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    return std::max_element(counts.begin(), counts.end(), fewer)->first;
}

// Equates the old background and the dropped value.
template <typename T>
struct Dropped {
    T oldBackground;
    T value;

    bool isActive(T voxel, bool active) const { return active && voxel != value; }
    T valueOf(T voxel, bool active) const {
        return !active && voxel == oldBackground ? value : voxel;
    }
    // Whether the voxel differs from the new background.
    bool matters(T voxel, bool active) const {
        return isActive(voxel, active) || valueOf(voxel, active) != value;
    }
};

// Returns null for a leaf that equals the background.
template <typename Leaf, typename T>
std::unique_ptr<Leaf> copyLeaf(const Leaf& leaf, const Dropped<T>& dropped) {
    bool matters = false;
    for (openvdb::Index i = 0; i < Leaf::SIZE && !matters; ++i) {
        matters = dropped.matters(leaf.getValue(i), leaf.isValueOn(i));
    }
    if (!matters) return nullptr;
    auto copy = std::make_unique<Leaf>(leaf);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const T voxel = leaf.getValue(i);
        const bool active = leaf.isValueOn(i);
        copy->setValueOnly(i, dropped.valueOf(voxel, active));
        copy->setActiveState(i, dropped.isActive(voxel, active));
    }
    return copy;
}

template <typename Tree>
std::shared_ptr<openvdb::TreeBase> drop(const Tree& tree, double value) {
    using Leaf = typename Tree::LeafNodeType;
    using T = typename Tree::ValueType;
    const Dropped<T> dropped{tree.background(), T(value)};
    typename Tree::Ptr made(new Tree(T(value)));

    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const bool active = tile.isValueOn();
        if (!dropped.matters(*tile, active)) continue;
        made->addTile(tile.getLevel(), tile.getCoord(), dropped.valueOf(*tile, active), active);
    }

    std::vector<const Leaf*> leaves;
    tree.getNodes(leaves);
    std::vector<std::unique_ptr<Leaf>> copies(leaves.size());
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) copies[i] = copyLeaf(*leaves[i], dropped);
    });
    for (std::unique_ptr<Leaf>& leaf : copies) {
        if (leaf) made->addLeaf(leaf.release());
    }
    return made;
}

// Whether each code stands for the value in a grid of type T.
template <typename T>
std::vector<bool> codesOf(const CodeBook& book, double value) {
    std::vector<bool> codes;
    for (const double other : valuesOfCodes(book))
        codes.push_back(valueAs<T>(other) == valueAs<T>(value));
    return codes;
}

std::vector<bool> codesOf(const CodeBook& book, double value, const std::string& type) {
    if (type == "float") return codesOf<float>(book, value);
    return codesOf<double>(book, value);
}

// Returns null for a leaf that becomes empty.
std::unique_ptr<CodeTree::Leaf> leafWithout(const CodeTree::Leaf& leaf,
                                            const std::vector<bool>& dropped) {
    auto copy = std::make_unique<CodeTree::Leaf>(leaf);
    const Code* const codes = leaf.buffer().data();
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
        if (dropped[codes[voxel.pos()]]) copy->setValueOff(voxel.pos());
    }
    return copy->isEmpty() ? nullptr : std::move(copy);
}

}  // namespace

double mostFrequentValue(const Volume& volume) {
    const bool known = !volume.hasBackground() && volume.mostFrequent();
    if (known && volume.mostFrequent()->count > 0) return volume.mostFrequent()->value;
    const auto& counts = volume.histogram();
    const auto code = Code(std::max_element(counts.begin(), counts.end()) - counts.begin());
    double value = volume.empty() ? 0 : volume.codeBook().valueOf(code);
    if (volume.empty() || volume.codeBook().isExact() || !volume.source()) return value;
    volume.source()->grid.apply<ScalarTrees>(
        [&](const auto& tree) { value = mostFrequentOf(tree, volume.codeBook(), code); });
    return value;
}

TreeGrid dropBackground(const TreeGrid& grid, double value) {
    TreeGrid result{nullptr, grid.metadata, grid.map};
    grid.apply<ScalarTrees>([&](const auto& tree) { result.tree = drop(tree, value); });
    return result;
}

void dropBackground(Volume& volume, double value, const std::string& type) {
    const std::vector<bool> dropped = codesOf(volume.codeBook(), value, type);
    const CodeTree::Tree& tree = volume.codes()->tree();
    std::vector<const CodeTree::Leaf*> leaves;
    tree.getNodes(leaves);
    requireMemory("grid \"" + volume.name() + "\"",
                  double(leaves.size()) * leafBytes<CodeTree::Leaf>());
    std::vector<std::unique_ptr<CodeTree::Leaf>> copies(leaves.size());
    forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) copies[i] = leafWithout(*leaves[i], dropped);
    });
    auto kept = std::make_shared<CodeTree>();
    openvdb::tree::ValueAccessor<CodeTree::Tree> accessor(kept->tree());
    for (std::unique_ptr<CodeTree::Leaf>& leaf : copies) {
        if (leaf) accessor.addLeaf(leaf.release());
    }
    forActiveTiles(tree, [&](const auto& tile) {
        if (!dropped[*tile]) accessor.addTile(tile.getLevel(), tile.getCoord(), *tile, true);
    });
    VolumeData left = volume.data();
    for (std::size_t code = 0; code < left.histogram.size(); ++code) {
        if (dropped[code]) left.histogram[code] = 0;
    }
    left.codes = kept;
    volume = Volume(std::move(left));
}

}  // namespace deltasplat
