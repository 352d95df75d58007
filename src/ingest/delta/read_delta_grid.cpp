// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/read_delta_grid.h"

#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "ingest/codes/code_statistics.h"
#include "ingest/delta/decode_blocks.h"
#include "ingest/delta/decode_deltas.h"
#include "ingest/delta/delta_stream.h"
#include "ingest/delta/leaf_columns.h"
#include "ingest/delta/read_exact_deltas.h"
#include "ingest/delta/restored_grid.h"
#include "ingest/delta/stream_columns.h"
#include "ingest/grids/grid_codes.h"
#include "ingest/grids/grid_metadata.h"
#include "ingest/grids/grid_volume.h"
#include "ingest/grids/source_grid.h"
#include "ingest/grids/tree_from_codes.h"
#include "ingest/readers.h"
#include "ingest/values/value_cast.h"
#include "ingest/vdb/vdb_transform.h"
#include "length_unit.h"
#include "listener_part.h"
#include "memory.h"
#include "printable.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(where, got, expected));
}

// The delta grid's axes are the source's in (slice, u, v) order.
glm::dmat4 sourceTransform(const openvdb::math::MapBase& map, int sliceAxis) {
    const glm::dmat4 permuted = matrixOf(map);
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

std::string sourceClass(const VdbMetadata& metadata) {
    const auto found =
        metadata.get<std::string>(std::string(kSourcePrefix) + openvdb::GridBase::META_GRID_CLASS);
    return found ? printable(*found) : kUnknownClass;
}

// All of a volume but its voxels.
Volume describe(const DeltaHeader& header, const VdbMetadata& metadata,
                const openvdb::math::MapBase& map, const std::string& where) {
    Volume volume;
    volume.space = header.space;
    volume.lengthUnit = lengthUnitNamed(metadata.text(kLengthUnitKey));
    volume.labels = labelsIn(metadata);
    volume.origin = originOf(header);
    volume.gridClass = sourceClass(metadata);
    volume.worldFromIndex = sourceTransform(map, header.sliceAxis);
    settleUnit(where, volume);
    return volume;
}

// The grid has the type that its code book asks for, or of packed deltas that of words.
void requireType(const TreeGrid& grid, const DeltaHeader& header, const std::string& where) {
    const std::string expected = header.isWide() || header.isPacked() ? "int64" : "int32";
    if (grid.type() == expected) return;
    fail(where, "deltas of type " + grid.type(),
         expected + " for " +
             (header.isPacked() ? "packed deltas" : "the code book " + header.bookName()));
}

// @param active  box of the active voxels
void fillVolume(const DeltaHeader& header, std::shared_ptr<const CodeTree> codes,
                std::vector<std::uint64_t> histogram, const IndexBox& active, Volume& volume) {
    volume.type = header.sourceType;
    volume.hasBackground = !header.restActive;
    volume.background = header.restActive ? 0 : header.background;
    volume.codeBook = header.book;
    volume.box = header.restActive ? header.box : active;
    volume.histogram = std::move(histogram);
    volume.codes = std::move(codes);
    summarize(volume);
}

// Returns the first and the last of the blocks of slices that wanted ones add up from.
std::optional<glm::ivec2> blocksToRead(const DeltaHeader& header, const SlicesWanted* wanted) {
    if (!wanted) return std::nullopt;
    const int first = toSliceOrder(header.box.min, header.sliceAxis).x >> 3;
    const int last = toSliceOrder(header.box.max, header.sliceAxis).x >> 3;
    const glm::ivec2 blocks = glm::clamp(wanted->blocks, first, last);
    return glm::ivec2(slabStart(header, blocks.x), blocks.y);
}

// Reads what of a delta grid is wanted, which stays packed.
// @param leaves  of all the grid; outlives what is returned
// @return null if it has to be read as a whole
std::unique_ptr<const DeltaColumns> columnsOf(VdbLeaves& leaves, const DeltaHeader& header,
                                              const SlicesWanted* wanted,
                                              const std::string& where) {
    const std::optional<glm::ivec2> blocks = blocksToRead(header, wanted);
    if (header.isPacked()) {
        auto stream = StreamColumns::read(leaves, header, blocks, where);
        if (!stream) return nullptr;
        return std::make_unique<StreamColumns>(std::move(*stream));
    }
    if (blocks) leaves.keep(8 * blocks->x, 8 * blocks->y + 7);
    requireMemory(where, double(leaves.bytes()));
    leaves.hold();
    return std::make_unique<LeafColumns>(leaves);
}

// What is said of a whole volume may come from anywhere.
bool mayBeBoxOf(const DeltaHeader& header, const IndexBox& box) {
    const IndexBox& all = header.box;
    if (header.restActive) return box == all;
    return !box.empty() && glm::all(glm::greaterThanEqual(box.min, all.min)) &&
           glm::all(glm::lessThanEqual(box.max, all.max));
}

}  // namespace

Volume readDeltaGrid(TreeGrid& stored, const VdbMetadata& fileMetadata, const std::string& where,
                     const ReadOptions& options, const Listener& all) {
    const DeltaHeader header = takeDeltaHeader(stored.metadata, where);
    requireType(stored, header, where);
    UnpackedDeltas unpacked;
    if (header.isPacked()) unpacked = unpackDeltas(stored, header, where, partOf(all, 0, 0.3));
    const Listener listener = partOf(all, header.isPacked() ? 0.3 : 0, 1);
    TreeGrid& grid = header.isPacked() ? unpacked.grid : stored;
    Volume volume = describe(header, grid.metadata, *grid.map, where);
    volume.name = grid.name();
    if (header.exact) {
        readExactDeltas(grid, header, fileMetadata, {listener, where, header.sourceType, options},
                        volume);
        return volume;
    }
    DecodedDeltas decoded = decodeDeltas(grid, header, where, listener);
    if (!unpacked.said.histogram.empty()) {
        const CodeTree::Tree& codes = decoded.codes->tree();
        requireKnownCodes(unpacked.said, {histogramOf(codes), activeBox(codes)}, where);
    }
    const bool changes =
        (options.levelSetToFog || options.levelSetSurface) && volume.gridClass == kLevelSetClass;
    TreeGrid source;
    if (!header.sourceTree.empty() && (options.keepSource || changes)) {
        source = restoreGrid(header, decoded, grid, volume.worldFromIndex);
    }
    // Values between two floats come back as the nearer one.
    if (options.keepSource && header.sourceType == "float32" && !header.book.isExact()) {
        source = {treeFromCodes<openvdb::FloatTree>(decoded.codes->tree(), header.book, 0),
                  {},
                  makeMapIfAny(volume.worldFromIndex)};
        source.metadata.insert(openvdb::GridBase::META_GRID_NAME, grid.name());
    }
    if (changes && source.tree) {
        decoded = {};
        fillFromGrid(source, {listener, where, header.sourceType, options}, volume);
    } else {
        const CodeTree::Tree& codes = decoded.codes->tree();
        fillVolume(header, decoded.codes, histogramOf(codes), activeBox(codes), volume);
        requireActiveCount(volume.activeCount, header, where);
    }
    if (options.keepSource && source.tree)
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{std::move(source), fileMetadata});
    return volume;
}

std::optional<Volume> readDeltaBlocks(const VdbFile& file, const VdbGrid& grid,
                                      const std::string& where, const ReadOptions& options,
                                      const Listener& listener, const SlicesWanted* wanted) {
    if (grid.type != "int32" && grid.type != "int64") return std::nullopt;
    const auto known = std::make_shared<DeltaHeader>();
    DeltaHeader& header = *known;
    std::optional<VdbLeaves> leaves;
    std::unique_ptr<const DeltaColumns> columns;
    Volume volume;
    try {
        const VdbMetadata metadata = file.metadata(grid);
        if (!isDeltaGrid(grid.type, metadata)) return std::nullopt;
        header = takeDeltaHeader(metadata, where);
        const bool changes = (options.levelSetToFog || options.levelSetSurface) &&
                             sourceClass(metadata) == kLevelSetClass;
        if (!mayDecodeBlocks(header) || changes) return std::nullopt;
        // Exact codes say all of a volume without empty places.
        const bool codesAreAll = header.restActive && header.book.isExact();
        if (options.keepSource && !codesAreAll) return std::nullopt;
        if ((grid.type == "int64") != header.isPacked()) return std::nullopt;
        if (wanted && !mayBeBoxOf(header, wanted->box)) return std::nullopt;
        leaves =
            file.readLeaves(grid, wanted ? VdbFile::Find::kByNotesAlone : VdbFile::Find::kByNotes);
        if (!leaves) return std::nullopt;
        columns = columnsOf(*leaves, header, wanted, where);
        if (!columns) return std::nullopt;
        worldFromIndexOf(leaves->transform(), where);
        volume = describe(header, metadata, leaves->transform(), where);
    } catch (const Error& error) {
        // What is wrong is said by who reads the grid as a whole.
        if (error.code() != ErrorCode::kInput) throw;
        return std::nullopt;
    }
    if (options.readLater && !options.keepSource && columns->knownCodes()) {
        CodesInUse all = columns->knownCodes()->all;
        auto later = decodeLater(known, std::move(columns), where);
        if (!later) return std::nullopt;
        fillVolume(header, std::make_shared<const CodeTree>(std::move(later)),
                   std::move(all.histogram), all.active, volume);
        return volume;
    }
    const std::optional<glm::ivec2> blocks = wanted ? std::optional(wanted->blocks) : std::nullopt;
    std::optional<DecodedBlocks> decoded = decodeBlocks(*columns, header, where, blocks, listener);
    if (!decoded) return std::nullopt;
    if (wanted) {
        decoded->blocks->setFacts(wanted->facts);
        decoded->histogram = wanted->histogram;
        decoded->active = wanted->box;
    }
    fillVolume(header, std::make_shared<const CodeTree>(std::move(decoded->blocks)),
               std::move(decoded->histogram), decoded->active, volume);
    if (volume.activeCount != header.active) return std::nullopt;
    return volume;
}

}  // namespace deltasplat
