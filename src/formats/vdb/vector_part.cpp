// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/vector_part.h"

#include <openvdb/tree/LeafManager.h>

#include "base/parallel.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

template <typename PartTree, typename VectorTree>
std::shared_ptr<PartTree> partOf(const VectorTree& vectors, int axis) {
    auto tree =
        std::make_shared<PartTree>(vectors, vectors.background()[axis], openvdb::TopologyCopy());
    // Values above the leaves are those of tiles.
    auto tiles = vectors.cbeginValueOn();
    tiles.setMaxDepth(VectorTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tiles; ++tiles) {
        tree->addTile(openvdb::Index(PartTree::DEPTH - 1 - tiles.getDepth()), tiles.getCoord(),
                      tiles.getValue()[axis], true);
    }
    const openvdb::tree::LeafManager<const VectorTree> from(vectors);
    openvdb::tree::LeafManager<PartTree> to(*tree);
    parallelFor(to.leafCount(), [&](std::size_t leaf) {
        auto* values = to.leaf(leaf).buffer().data();
        const auto* all = from.leaf(leaf).buffer().data();
        for (openvdb::Index i = 0; i < PartTree::LeafNodeType::SIZE; ++i) values[i] = all[i][axis];
    });
    return tree;
}

}  // namespace

bool isVector(const VdbGrid& grid) {
    return grid.supported && (grid.type == "vec3s" || grid.type == "vec3d" || grid.type == "vec3i");
}

std::optional<VectorPart> vectorPartOf(const std::string& name) {
    if (name.size() < 3 || name[name.size() - 2] != '.') return {};
    const int axis = name.back() - 'x';
    if (axis < 0 || axis > 2) return {};
    return VectorPart{name.substr(0, name.size() - 2), axis};
}

TreeGrid gridOfPart(const TreeGrid& grid, int axis) {
    TreeGrid part{nullptr, grid.metadata, grid.map};
    if (const auto* const doubles = grid.as<openvdb::Vec3DTree>()) {
        part.tree = partOf<openvdb::DoubleTree>(*doubles, axis);
    } else if (const auto* const integers = grid.as<openvdb::Vec3ITree>()) {
        part.tree = partOf<openvdb::Int32Tree>(*integers, axis);
    } else {
        part.tree = partOf<openvdb::FloatTree>(*grid.as<openvdb::Vec3STree>(), axis);
    }
    return part;
}

}  // namespace deltasplat
