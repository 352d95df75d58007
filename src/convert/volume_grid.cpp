// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_grid.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <type_traits>
#include <vector>

#include "convert/value_facts.h"
#include "ingest/codes/code_tree.h"
#include "ingest/codes/code_values.h"
#include "ingest/grids/grid_metadata.h"
#include "ingest/grids/grid_values.h"
#include "ingest/grids/source_grid.h"
#include "ingest/values/value_cast.h"
#include "ingest/vdb/vdb_transform.h"
#include "vdb/code_values.h"

namespace deltasplat {
namespace {

using openvdb::GridBase;  // for names of metadata

template <typename SourceLeaf, typename Leaf, typename ValueOf>
void fillLeaf(const SourceLeaf& source, Leaf& leaf, const ValueOf& valueOf) {
    using T = typename Leaf::ValueType;
    for (auto voxel = source.cbeginValueOn(); voxel; ++voxel) {
        const T value = valueOf(*voxel);
        if constexpr (std::is_same_v<T, bool>) {
            leaf.setValueOnly(voxel.pos(), value);
        } else {
            leaf.buffer().data()[voxel.pos()] = value;
        }
    }
}

// Makes a tree with the active voxels and tiles of `tree`, whose values `valueOf` translates.
template <typename Made, typename Tree, typename ValueOf>
std::shared_ptr<Made> translate(const Tree& tree, const ValueOf& valueOf, double background) {
    using T = typename Made::ValueType;
    // OpenVDB's trees cannot be assigned, only made in place.
    auto made = std::make_shared<Made>(tree, valueAs<T>(background), openvdb::TopologyCopy());
    // The leaves of a mask are all topology.
    if constexpr (!std::is_same_v<Made, openvdb::MaskTree>) {
        std::vector<const typename Tree::LeafNodeType*> sources;
        std::vector<typename Made::LeafNodeType*> leaves;
        tree.getNodes(sources);
        made->getNodes(leaves);
        forLeafRuns(leaves.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) fillLeaf(*sources[i], *leaves[i], valueOf);
        });
    }
    forActiveTiles(
        *made, [&](const auto& tile) { tile.setValue(valueOf(tree.getValue(tile.getCoord()))); });
    return made;
}

template <typename Tree>
std::shared_ptr<Tree> fromCodes(const Volume& volume) {
    using T = typename Tree::ValueType;
    const std::vector<double> values = valuesOfCodes(volume.codeBook);
    return translate<Tree>(
        volume.codes->tree(), [&](Code code) { return valueAs<T>(values[code]); },
        volume.hasBackground ? volume.background : 0);
}

// Whether OpenVDB has grids of a type.
bool isGridType(const std::string& type) {
    const auto types = {"float", "half", "double", "int32", "int64", "bool", "mask"};
    return std::find(types.begin(), types.end(), type) != types.end();
}

// What a volume without OpenVDB's types becomes.
std::string smallestType(const ValueFacts& facts) {
    if (facts.fit(RawType::kFloat32)) return "float";
    if (facts.fit(RawType::kInt32)) return "int32";
    return facts.doubleError == 0 ? "double" : "int64";
}

std::shared_ptr<openvdb::TreeBase> fromCodes(const Volume& volume, const std::string& type) {
    if (type == "double") return fromCodes<openvdb::DoubleTree>(volume);
    if (type == "int32") return fromCodes<openvdb::Int32Tree>(volume);
    if (type == "int64") return fromCodes<openvdb::Int64Tree>(volume);
    if (type == "bool") return fromCodes<openvdb::BoolTree>(volume);
    if (type == "mask") return fromCodes<openvdb::MaskTree>(volume);
    return fromCodes<openvdb::FloatTree>(volume);
}

template <typename Made>
std::shared_ptr<Made> fromSource(const TreeGrid& source) {
    std::shared_ptr<Made> made;
    const auto make = [&](const auto& tree) {
        made = translate<Made>(
            tree, [](auto value) { return typename Made::ValueType(value); }, 0);
    };
    source.apply<TreeTypes<openvdb::DoubleTree, openvdb::Int64Tree, openvdb::Int32Tree>>(make);
    return made;
}

// The tree of a dense source may have a wider type than its values need.
std::shared_ptr<openvdb::TreeBase> fromSource(const TreeGrid& source, const std::string& type) {
    if (type == source.type()) return source.tree;
    if (type == "float") return fromSource<openvdb::FloatTree>(source);
    if (type == "int32") return fromSource<openvdb::Int32Tree>(source);
    return fromSource<openvdb::DoubleTree>(source);
}

VdbMetadata metadataOf(const Volume& volume) {
    VdbMetadata metadata;
    metadata.insert(GridBase::META_GRID_NAME, volume.name);
    metadata.insert(GridBase::META_GRID_CREATOR, std::string("deltasplat " DELTASPLAT_VERSION));
    metadata.insert(GridBase::META_GRID_CLASS, volume.gridClass);
    metadata.insert(GridBase::META_GRID_CLASS, gridClassOf(metadata));
    if (!volume.hasBackground) {
        metadata.insert(kSourceTypeKey, volume.type);
        metadata.insert(kBoxMinKey, volume.box.min);
        metadata.insert(kBoxMaxKey, volume.box.max);
    }
    if (!volume.space.empty()) metadata.insert(kSpaceKey, volume.space);
    return metadata;
}

template <typename Tree>
std::shared_ptr<const WrittenTree> writtenTree(const Volume& volume, double background) {
    using Values = CodeValues<Tree>;
    return std::make_shared<const TreeWriter<Values>>(
        Values(volume.codes, volume.codeBook, background));
}

std::shared_ptr<const WrittenTree> writtenTree(const Volume& volume, const std::string& type,
                                               double background) {
    if (type == "double") return writtenTree<openvdb::DoubleTree>(volume, background);
    if (type == "int32") return writtenTree<openvdb::Int32Tree>(volume, background);
    if (type == "int64") return writtenTree<openvdb::Int64Tree>(volume, background);
    if (type == "bool") return writtenTree<openvdb::BoolTree>(volume, background);
    if (type == "mask") return writtenTree<openvdb::MaskTree>(volume, background);
    return writtenTree<openvdb::FloatTree>(volume, background);
}

}  // namespace

std::string gridTypeOf(const Volume& volume) {
    const bool keepsType = volume.hasBackground && isGridType(volume.type);
    if (!keepsType) return smallestType(factsOf(volume));
    return volume.type == "half" ? "float" : volume.type;
}

WrittenGrid writtenCodes(const Volume& volume, const std::string& type, double background) {
    return {volume.name, metadataOf(volume), makeMap(volume.worldFromIndex),
            writtenTree(volume, type, background)};
}

TreeGrid gridOf(const Volume& volume) {
    if (volume.source && volume.hasBackground) return volume.source->grid;
    const std::string type = gridTypeOf(volume);
    return {volume.source ? fromSource(volume.source->grid, type) : fromCodes(volume, type),
            metadataOf(volume), makeMap(volume.worldFromIndex)};
}

}  // namespace deltasplat
