// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/read_delta_grid.h"

#include <cmath>
#include <glm/matrix.hpp>
#include <string_view>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/codes/code_statistics.h"
#include "ingest/delta/decode_deltas.h"
#include "ingest/delta/read_exact_deltas.h"
#include "ingest/delta/restored_grid.h"
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
    origin.deltas = header.deltas();
    origin.codeBook = header.bookName();
    origin.tolerance = header.tolerance;
    origin.toleranceValue = header.toleranceValue;
    origin.maxError = header.maxError;
    return origin;
}

// The grid has the type that its code book asks for.
void requireType(const openvdb::GridBase& grid, const DeltaHeader& header,
                 const std::string& where) {
    const bool isWide = header.exact && *header.exact != ExactValues::kFloat32;
    const std::string expected = isWide ? "int64" : "int32";
    if (grid.valueType() == expected) return;
    fail(where, "deltas of type " + grid.valueType(),
         expected + " for the code book " + header.bookName());
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
    requireActiveCount(volume.activeCount, header, where);
}

}  // namespace

Volume readDeltaGrid(openvdb::GridBase& grid, const openvdb::MetaMap::ConstPtr& fileMetadata,
                     const std::string& where, const ReadOptions& options,
                     const Listener& listener) {
    const DeltaHeader header = takeDeltaHeader(grid, where);
    requireType(grid, header, where);
    Volume volume;
    volume.name = grid.getName();
    volume.space = header.space;
    volume.origin = originOf(header);
    volume.gridClass = sourceClass(grid);
    volume.worldFromIndex = sourceTransform(grid.transform(), header.sliceAxis);
    if (header.exact) {
        readExactDeltas(grid, header, fileMetadata, {listener, where, header.sourceType, options},
                        volume);
        return volume;
    }
    DecodedDeltas decoded = decodeDeltas(grid, header, where, listener);
    const bool fog = options.levelSetToFog && volume.gridClass == "level set";
    openvdb::GridBase::Ptr source;
    if (!header.sourceTree.empty() && (options.keepSource || fog)) {
        source = restoreGrid(header, decoded, grid, volume.worldFromIndex);
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
