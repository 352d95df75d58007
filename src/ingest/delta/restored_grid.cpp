// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/restored_grid.h"

#include <string_view>
#include <type_traits>
#include <vector>

#include "deltasplat/error.h"
#include "ingest/grids/grid_from_codes.h"
#include "ingest/grids/prune_same_bits.h"
#include "ingest/values/value_cast.h"
#include "ingest/vdb/vdb_transform.h"

namespace deltasplat {
namespace {

// Sets what inactive voxels hold where that is not the background, and makes tiles of what is
// uniform.
template <typename Tree>
void setInactive(const CodeTree::Tree& inactive, const std::vector<double>& values, Tree& tree) {
    openvdb::tree::ValueAccessor<Tree> accessor(tree);
    const auto valueOf = [&](Code number) {
        return valueAs<typename Tree::ValueType>(values[number]);
    };
    for (auto leaf = inactive.cbeginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
            accessor.setValueOff(voxel.getCoord(), valueOf(*voxel));
    }
    auto tile = inactive.cbeginValueOn();
    tile.setMaxDepth(CodeTree::Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) accessor.addTile(1, tile.getCoord(), valueOf(*tile), false);
    pruneSameBits(tree);
}

template <typename Grid>
openvdb::GridBase::Ptr restoredGrid(const DeltaHeader& header, const DecodedDeltas& decoded) {
    using Value = typename Grid::ValueType;
    auto grid =
        gridFromCodes<Grid>(decoded.codes->tree(), header.book, valueAs<Value>(header.background));
    setInactive(decoded.inactive->tree(), header.inactiveValues, grid->tree());
    return grid;
}

openvdb::GridBase::Ptr undressedGrid(const DeltaHeader& header, const DecodedDeltas& decoded) {
    if (header.sourceTree == "float") return restoredGrid<openvdb::FloatGrid>(header, decoded);
    if (header.sourceTree == "double") return restoredGrid<openvdb::DoubleGrid>(header, decoded);
    if (header.sourceTree == "int32") return restoredGrid<openvdb::Int32Grid>(header, decoded);
    if (header.sourceTree == "int64") return restoredGrid<openvdb::Int64Grid>(header, decoded);
    if (header.sourceTree == "bool") return restoredGrid<openvdb::BoolGrid>(header, decoded);
    return restoredGrid<openvdb::MaskGrid>(header, decoded);
}

// Puts the source's own metadata back under their names.
void restoreMetadata(const openvdb::MetaMap& from, openvdb::MetaMap& to) {
    const std::string_view prefix = kSourcePrefix;
    to.clearMetadata();
    for (auto entry = from.beginMeta(); entry != from.endMeta(); ++entry) {
        if (entry->first.starts_with(prefix) && entry->first.size() > prefix.size())
            to.insertMeta(entry->first.substr(prefix.size()), *entry->second);
    }
}

// Gives a grid all of the source but its voxels.
void dress(openvdb::GridBase& grid, const openvdb::GridBase& deltas, const DeltaHeader& header,
           const glm::dmat4& worldFromIndex) {
    restoreMetadata(deltas, grid);
    grid.setTransform(makeTransformOfType(header.sourceMap, worldFromIndex));
}

}  // namespace

openvdb::GridBase::Ptr restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded,
                                   const openvdb::GridBase& deltas,
                                   const glm::dmat4& worldFromIndex) {
    const openvdb::GridBase::Ptr grid = undressedGrid(header, decoded);
    dress(*grid, deltas, header, worldFromIndex);
    return grid;
}

openvdb::GridBase::Ptr restoreGrid(const DeltaHeader& header, const DecodedValues& decoded,
                                   const openvdb::GridBase& deltas,
                                   const glm::dmat4& worldFromIndex) {
    const openvdb::GridBase::Ptr grid = decoded.values;
    grid->apply<ExactGrids>([&](auto& typed) {
        setInactive(decoded.inactive->tree(), header.inactiveValues, typed.tree());
    });
    if (header.sourceTree.empty()) {
        grid->setName(deltas.getName());
        grid->setTransform(makeTransform(worldFromIndex));
    } else {
        dress(*grid, deltas, header, worldFromIndex);
    }
    return grid;
}

void requireActiveCount(std::uint64_t active, const DeltaHeader& header, const std::string& where) {
    if (active == header.active) return;
    throw Error(ErrorCode::kInput,
                gotExpected(where, std::to_string(active) + " active voxels",
                            std::to_string(header.active) + ", as \"delta_active\" says"));
}

}  // namespace deltasplat
