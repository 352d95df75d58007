// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/read_delta_grid.h"

#include <openvdb/tools/Prune.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <numeric>
#include <string_view>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/codes/code_statistics.h"
#include "ingest/delta/decode_deltas.h"
#include "ingest/grids/grid_codes.h"
#include "ingest/grids/grid_from_codes.h"
#include "ingest/grids/source_grid.h"
#include "ingest/readers.h"
#include "ingest/values/value_cast.h"
#include "ingest/vdb/vdb_transform.h"
#include "printable.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

// The delta grid's axes are the source's in (slice, u, v) order.
glm::dmat4 sourceTransform(const openvdb::math::Transform& transform, int sliceAxis) {
    const glm::dmat4 permuted = matrixOf(transform);
    const glm::ivec3 order = sliceOrder(sliceAxis);
    glm::dmat4 matrix = permuted;
    for (int axis = 0; axis < 3; ++axis) matrix[order[axis]] = permuted[axis];
    return matrix;
}

DeltaOrigin originOf(const DeltaHeader& header) {
    DeltaOrigin origin;
    origin.sliceAxis = header.sliceAxis;
    origin.keyInterval = header.keyInterval;
    origin.deltas =
        std::accumulate(header.slabDeltas.begin(), header.slabDeltas.end(), std::uint64_t{0});
    origin.tolerance = header.tolerance;
    origin.toleranceValue = header.toleranceValue;
    origin.maxError = header.maxError;
    return origin;
}

// Sets what inactive voxels hold where that is not the background.
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
}

template <typename Grid>
openvdb::GridBase::Ptr restoredGrid(const DeltaHeader& header, const DecodedDeltas& decoded) {
    using Value = typename Grid::ValueType;
    auto grid =
        gridFromCodes<Grid>(decoded.codes->tree, header.book, valueAs<Value>(header.background));
    if constexpr (!std::is_same_v<Grid, openvdb::MaskGrid>) {
        setInactive(decoded.inactive->tree, header.inactiveValues, grid->tree());
        openvdb::tools::prune(grid->tree());
    }
    return grid;
}

openvdb::GridBase::Ptr restoreGrid(const DeltaHeader& header, const DecodedDeltas& decoded) {
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

std::string sourceClass(const openvdb::MetaMap& metadata) {
    const auto found = metadata.getMetadata<openvdb::StringMetadata>(
        std::string(kSourcePrefix) + openvdb::GridBase::META_GRID_CLASS);
    return found ? printable(found->value()) : "unknown";
}

void fillVolume(const DeltaHeader& header, DecodedDeltas decoded, const std::string& where,
                Volume& volume) {
    volume.type = header.sourceType;
    volume.hasBackground = !header.restActive;
    volume.background = header.restActive ? 0 : header.background;
    volume.codeBook = header.book;
    volume.box = header.restActive ? header.box : activeBox(decoded.codes->tree);
    volume.histogram = histogramOf(decoded.codes->tree);
    volume.codes = std::move(decoded.codes);
    summarize(volume);
    if (volume.activeCount == header.active) return;
    fail(where, std::to_string(volume.activeCount) + " active voxels",
         std::to_string(header.active) + ", as \"delta_active\" says");
}

}  // namespace

Volume readDeltaGrid(openvdb::Int32Grid& grid, const openvdb::MetaMap::ConstPtr& fileMetadata,
                     const std::string& where, const ReadOptions& options,
                     const Listener& listener) {
    const DeltaHeader header = takeDeltaHeader(grid, where);
    DecodedDeltas decoded = decodeDeltas(grid, header, where, listener);

    Volume volume;
    volume.name = grid.getName();
    volume.space = header.space;
    volume.origin = originOf(header);
    volume.gridClass = sourceClass(grid);
    volume.worldFromIndex = sourceTransform(grid.transform(), header.sliceAxis);
    const bool fog = options.levelSetToFog && volume.gridClass == "level set";
    openvdb::GridBase::Ptr source;
    if (!header.sourceTree.empty() && (options.keepSource || fog)) {
        source = restoreGrid(header, decoded);
        restoreMetadata(grid, *source);
        source->setTransform(makeTransformOfType(header.sourceMap, volume.worldFromIndex));
    }
    // Values between two floats come back as the nearer one.
    if (options.keepSource && header.sourceType == "float32" && !header.book.isExact()) {
        source = gridFromCodes<openvdb::FloatGrid>(decoded.codes->tree, header.book, 0);
        source->setName(grid.getName());
        source->setTransform(makeTransform(volume.worldFromIndex));
    }
    if (fog && source) {
        decoded = {};
        fillFromGrid(*source, {listener, where, header.sourceType, options}, volume);
    } else {
        fillVolume(header, std::move(decoded), where, volume);
    }
    if (options.keepSource && source)
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{std::move(source), fileMetadata});
    return volume;
}

}  // namespace deltasplat
