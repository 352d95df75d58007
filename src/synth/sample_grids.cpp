// SPDX-License-Identifier: Apache-2.0
#include "synth/sample_grids.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cstdint>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "formats/vdb/grid_metadata.h"
#include "synth/volumes.h"
#include "volume/leaf_bytes.h"
#include "volume/tree_types.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using ColorLeaf = openvdb::Vec3STree::LeafNodeType;

// Samples 8^3 voxels; null if nothing there is above the threshold. Voxels beyond the volume's dims
// stay inactive.
std::unique_ptr<Leaf> sampleLeaf(const AnalyticGrid& sampled, const openvdb::Coord& origin,
                                 const AnalyticFileOptions& options) {
    const glm::ivec3& dims = options.dims;
    auto leaf = std::make_unique<Leaf>(origin, 0.0f);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const openvdb::Coord at = leaf->offsetToGlobalCoord(i);
        if (at.x() >= dims.x || at.y() >= dims.y || at.z() >= dims.z) continue;
        const auto value = float(sampleVoxel(sampled.valueAt, {at.x(), at.y(), at.z()}, options));
        if (value != 0 && double(value) > sampled.threshold) leaf->setValueOn(i, value);
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
}

// A leaf that is one value throughout takes no more memory than a tile.
void addLeaf(openvdb::FloatTree& tree, std::unique_ptr<Leaf> leaf) {
    float value = 0;
    bool active = false;
    if (!leaf) return;
    if (leaf->isConstant(value, active)) {
        tree.addTile(1, leaf->origin(), value, active);
    } else {
        tree.addLeaf(leaf.release());
    }
}

// Makes tiles of what is uniform, as OpenVDB's prune does, which its library has.
void pruneUniform(openvdb::FloatTree& tree) {
    openvdb::tree::NodeManager<openvdb::FloatTree, openvdb::FloatTree::DEPTH - 2> nodes(tree);
    nodes.foreachBottomUp(openvdb::tools::TolerancePruneOp<openvdb::FloatTree>(tree, 0.0f));
}

openvdb::FloatTree::Ptr sampleScalars(const AnalyticGrid& sampled,
                                      const AnalyticFileOptions& options,
                                      const Listener& listener) {
    constexpr int kEdge = int(Leaf::DIM);
    const glm::ivec3 leaves = (options.dims - 1) / kEdge + 1;
    auto tree = std::make_shared<openvdb::FloatTree>(0.0f);
    // One layer of leaves at a time keeps the work in large pieces and the list of them short.
    const std::size_t layerLeaves = std::size_t(leaves.y) * std::size_t(leaves.z);
    // What a layer takes is known only when it is there, so room is asked for one full layer more.
    constexpr double kLeafBytes = leafBytes<Leaf>() + sizeof(void*);
    requireMemory("`dims`", kLeafBytes * double(layerLeaves));
    std::vector<std::unique_ptr<Leaf>> layer(layerLeaves);
    for (int x = 0; x < leaves.x; ++x) {
        requireMemory("`dims`", kLeafBytes * double(layerLeaves));
        parallelFor(layer.size(), [&](std::size_t i) {
            const int y = int(i / std::size_t(leaves.z)), z = int(i % std::size_t(leaves.z));
            layer[i] = sampleLeaf(sampled, {x * kEdge, y * kEdge, z * kEdge}, options);
        });
        for (std::unique_ptr<Leaf>& leaf : layer) addLeaf(*tree, std::move(leaf));
        listener.report(double(x + 1) / leaves.x);
    }
    pruneUniform(*tree);
    return tree;
}

void colorLeaf(const AnalyticVolume& volume, const AnalyticFileOptions& options, ColorLeaf& leaf) {
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        const openvdb::Coord at = voxel.getCoord();
        const glm::vec3 color(sampleVoxel(volume.colorAt, {at.x(), at.y(), at.z()}, options));
        voxel.setValue({color.r, color.g, color.b});
    }
}

// Smoke that is one value throughout has colours of its own: its tiles become leaves.
openvdb::Vec3STree::Ptr sampleColors(const AnalyticVolume& volume, const openvdb::FloatTree& shape,
                                     const AnalyticFileOptions& options, const Listener& listener) {
    constexpr std::size_t kBatch = 4096;  // leaves
    const double mostLeaves =
        double(shape.leafCount()) + double(shape.activeVoxelCount()) / ColorLeaf::SIZE;
    requireMemory("`dims`", leafBytes<ColorLeaf>() * mostLeaves);
    auto tree =
        std::make_shared<openvdb::Vec3STree>(shape, openvdb::Vec3s(0.0f), openvdb::TopologyCopy());
    tree->voxelizeActiveTiles(/*threaded=*/false);
    std::vector<ColorLeaf*> leaves;
    tree->getNodes(leaves);
    for (std::size_t first = 0; first < leaves.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, leaves.size() - first);
        parallelFor(count, [&](std::size_t i) { colorLeaf(volume, options, *leaves[first + i]); });
        listener.report(double(first + count) / double(leaves.size()));
    }
    return tree;
}

}  // namespace

std::vector<TreeGrid> sampleGrids(const AnalyticVolume& volume, const AnalyticFileOptions& options,
                                  const Listener& listener) {
    const double parts = 1 + double(volume.others.size()) + (volume.colorAt ? 1 : 0);
    const auto map = makeMap(glm::scale(glm::dmat4(1), options.spacing));
    std::vector<TreeGrid> grids;
    const auto add = [&](std::shared_ptr<openvdb::TreeBase> tree, const std::string& name) {
        TreeGrid& grid = grids.emplace_back(TreeGrid{std::move(tree), {}, map});
        grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, name);
        grid.metadata.insert(openvdb::GridBase::META_GRID_CREATOR, std::string("deltasplat"));
    };
    const auto addFog = [&](std::shared_ptr<openvdb::TreeBase> tree, const std::string& name) {
        add(std::move(tree), name);
        grids.back().metadata.insert(openvdb::GridBase::META_GRID_CLASS, std::string(kFogClass));
    };
    const auto part = [&] {
        Listener own = listener;
        own.progress = [&, done = double(grids.size())](double share) {
            listener.report((done + share) / parts);
        };
        return own;
    };
    // Whatever is not 0 is density: there are volumes with values below it.
    constexpr double kNone = std::numeric_limits<double>::lowest();
    const auto density = sampleScalars({"density", volume.valueAt, kNone}, options, part());
    addFog(density, "density");
    for (const AnalyticGrid& other : volume.others)
        addFog(sampleScalars(other, options, part()), other.name);
    if (volume.colorAt) add(sampleColors(volume, *density, options, part()), "Cd");
    return grids;
}

}  // namespace deltasplat
