// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vector_part.h"

#include <openvdb/openvdb.h>
#include <openvdb/tree/LeafManager.h>

#include "parallel.h"

namespace deltasplat {
namespace {

template <typename PartGrid, typename VectorGrid>
openvdb::GridBase::Ptr partOf(const VectorGrid& grid, int axis) {
    using PartTree = typename PartGrid::TreeType;
    const auto& vectors = grid.tree();
    const auto tree =
        std::make_shared<PartTree>(vectors, vectors.background()[axis], openvdb::TopologyCopy());
    // Above leaves, values are those of tiles.
    auto tiles = vectors.cbeginValueOn();
    tiles.setMaxDepth(VectorGrid::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tiles; ++tiles) {
        tree->addTile(openvdb::Index(PartTree::DEPTH - 1 - tiles.getDepth()), tiles.getCoord(),
                      tiles.getValue()[axis], true);
    }
    const openvdb::tree::LeafManager<const typename VectorGrid::TreeType> from(vectors);
    openvdb::tree::LeafManager<PartTree> to(*tree);
    parallelFor(to.leafCount(), [&](std::size_t leaf) {
        auto* values = to.leaf(leaf).buffer().data();
        const auto* all = from.leaf(leaf).buffer().data();
        for (openvdb::Index i = 0; i < PartTree::LeafNodeType::SIZE; ++i) values[i] = all[i][axis];
    });
    const auto result = PartGrid::create(tree);
    static_cast<openvdb::MetaMap&>(*result) = grid;
    result->setTransform(grid.transform().copy());
    return result;
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

openvdb::GridBase::Ptr gridOfPart(const openvdb::GridBase& grid, int axis) {
    if (grid.isType<openvdb::Vec3DGrid>())
        return partOf<openvdb::DoubleGrid>(static_cast<const openvdb::Vec3DGrid&>(grid), axis);
    if (grid.isType<openvdb::Vec3IGrid>())
        return partOf<openvdb::Int32Grid>(static_cast<const openvdb::Vec3IGrid&>(grid), axis);
    return partOf<openvdb::FloatGrid>(static_cast<const openvdb::Vec3SGrid&>(grid), axis);
}

}  // namespace deltasplat
