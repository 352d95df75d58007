// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/read_delta_grid.h"

#include <openvdb/tools/Dense.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/matrix.hpp>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/progress.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "formats/delta/decode_blocks.h"
#include "formats/delta/decode_deltas.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/delta_stream.h"
#include "formats/delta/restored_grid.h"
#include "formats/dense/dense_source.h"
#include "formats/readers.h"
#include "formats/vdb/grid_codes.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/grid_volume.h"
#include "volume/code_counts.h"
#include "volume/placement.h"
#include "volume/tree_from_codes.h"
#include "volume/tree_grid.h"
#include "volume/value_cast.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

/// Turns a delta grid of exact values into the volume that reading its source would give.
/// @param volume  has its name, transform and origin; receives the rest
/// @throw as readDeltaGrid
void readExactDeltas(TreeGrid& deltas, const DeltaHeader& header, const VdbMetadata& fileMetadata,
                     const GridCodesOptions& options, VolumeData& volume);

namespace {

// Passes on a tree's box, layer by layer.
template <typename Tree>
void forEachLayer(const Tree& tree, const glm::ivec3& size, const DenseSource::LayerUse& use,
                  const Listener& listener) {
    using Value = typename Tree::ValueType;
    using Layer = openvdb::tools::Dense<Value, openvdb::tools::LayoutXYZ>;
    std::vector<Value> values(std::size_t(size.x) * std::size_t(size.y) *
                              DenseSource::kLayerSlices);
    for (int first = 0; first < size.z; first += DenseSource::kLayerSlices) {
        const int slices = std::min(size.z - first, DenseSource::kLayerSlices);
        Layer layer({{0, 0, first}, {size.x - 1, size.y - 1, first + slices - 1}}, values.data());
        openvdb::tools::copyToDense(tree, layer);
        use(first, slices, reinterpret_cast<const std::byte*>(values.data()));
        listener.report(double(first + slices) / double(size.z));
    }
}

constexpr RawType kRawTypes[] = {RawType::kFloat32, RawType::kFloat64, RawType::kInt32,
                                 RawType::kInt64};

DenseSource denseSource(const TreeGrid& grid, const DeltaHeader& header,
                        const GridCodesOptions& options, const VolumeData& volume) {
    DenseSource source;
    source.where = options.where;
    source.name = volume.name;
    source.dims = glm::i64vec3(header.box.dims());
    source.type = kRawTypes[int(*header.exact)];
    source.bigEndian = std::endian::native == std::endian::big;
    // Unsigned 64-bit values are stored as doubles; other types of whole numbers as themselves.
    source.standsForWhole = header.sourceType == "uint64";
    source.worldFromIndex = volume.worldFromIndex;
    source.space = header.space;
    source.lengthUnit = volume.lengthUnit;
    source.labels = volume.labels;
    source.forEachLayer = [&grid, size = header.box.dims()](const DenseSource::LayerUse& use,
                                                            const Listener& listener) {
        grid.apply<ExactTrees>([&](const auto& tree) { forEachLayer(tree, size, use, listener); });
    };
    return source;
}

}  // namespace

void readExactDeltas(TreeGrid& deltas, const DeltaHeader& header, const VdbMetadata& fileMetadata,
                     const GridCodesOptions& options, VolumeData& volume) {
    const std::string& where = options.where;
    const Listener decoding = partOf(options.listener, 0, 0.5);
    Listener reading = partOf(options.listener, 0.5, 1);
    TreeGrid source = restoreGrid(header, decodeValues(deltas, header, where, decoding), deltas,
                                  volume.worldFromIndex);
    requireActiveCount(source.tree->activeVoxelCount(), header, where);
    if (header.restActive) {
        ReadOptions codesOnly = options.reading;
        codesOnly.keepSource = codesOnly.keepInexact = false;
        // A volume that keeps its source has the exact values.
        if (options.reading.keepSource && !options.reading.bits) reading.warning = {};
        VolumeData dense =
            readDense(denseSource(source, header, options, volume), codesOnly, reading).data();
        dense.origin = volume.origin;
        dense.type = header.sourceType;
        dense.gridClass = volume.gridClass;
        volume = std::move(dense);
    } else {
        fillFromGrid(source, options, volume);
    }
    const bool isExact = volume.codeBook.isExact();
    const bool keeps = options.reading.keepSource ? volume.hasBackground || !isExact
                                                  : options.reading.keepInexact && !isExact;
    if (keeps)
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{std::move(source), fileMetadata});
}

}  // namespace

namespace {

// The delta grid's axes are the source's axes in (slice, u, v) order.
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

// Returns a volume without voxels.
VolumeData describe(const DeltaHeader& header, const VdbMetadata& metadata,
                    const openvdb::math::MapBase& map, const std::string& where) {
    VolumeData volume;
    volume.space = header.space;
    volume.lengthUnit = lengthUnitNamed(metadata.text(kLengthUnitKey));
    volume.labels = labelsIn(metadata);
    volume.origin = originOf(header);
    volume.gridClass = sourceClass(metadata);
    volume.worldFromIndex = sourceTransform(map, header.sliceAxis);
    settleUnit(where, volume);
    return volume;
}

// Requires the type of the code book's deltas, or of words in a packed grid.
void requireType(const TreeGrid& grid, const DeltaHeader& header, const std::string& where) {
    const std::string expected = header.isWide() || header.isPacked() ? "int64" : "int32";
    if (grid.type() == expected) return;
    refuseInput(where, "deltas of type " + grid.type(),
                expected + " for " +
                    (header.isPacked() ? "packed deltas" : "the code book " + header.bookName()));
}

void fillVolume(const DeltaHeader& header, std::shared_ptr<const CodeTree> codes,
                std::vector<std::uint64_t> histogram, const IndexBox& active, VolumeData& volume) {
    volume.type = header.sourceType;
    volume.hasBackground = !header.restActive;
    volume.background = header.restActive ? 0 : header.background;
    volume.codeBook = header.book;
    volume.box = header.restActive ? header.box : active;
    volume.histogram = std::move(histogram);
    volume.codes = std::move(codes);
    summarize(volume);
}

}  // namespace

VolumeData readDeltaGrid(TreeGrid& stored, const VdbMetadata& fileMetadata,
                         const std::string& where, const ReadOptions& options,
                         const Listener& all) {
    const DeltaHeader header = takeDeltaHeader(stored.metadata, where);
    requireType(stored, header, where);
    UnpackedDeltas unpacked;
    if (header.isPacked()) unpacked = unpackDeltas(stored, header, where, partOf(all, 0, 0.3));
    const Listener listener = partOf(all, header.isPacked() ? 0.3 : 0, 1);
    TreeGrid& grid = header.isPacked() ? unpacked.grid : stored;
    VolumeData volume = describe(header, grid.metadata, *grid.map, where);
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
    // Values between two floats become the nearer float.
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

std::optional<VolumeData> readDeltaBlocks(const VdbFile& file, const VdbGrid& grid,
                                          const std::string& where, const ReadOptions& options,
                                          const Listener& listener) {
    if (grid.type != "int64") return std::nullopt;
    const auto known = std::make_shared<DeltaHeader>();
    DeltaHeader& header = *known;
    std::unique_ptr<const StreamColumns> columns;
    VolumeData volume;
    try {
        const VdbMetadata metadata = file.metadata(grid);
        if (!isDeltaGrid(grid.type, metadata)) return std::nullopt;
        header = takeDeltaHeader(metadata, where);
        const bool changes = (options.levelSetToFog || options.levelSetSurface) &&
                             sourceClass(metadata) == kLevelSetClass;
        if (!header.isPacked() || !mayDecodeBlocks(header) || changes) return std::nullopt;
        // Exact codes are all of a volume without empty places.
        const bool codesAreAll = header.restActive && header.book.isExact();
        if (options.keepSource && !codesAreAll) return std::nullopt;
        const std::optional<VdbLeaves> leaves = file.readLeaves(grid, VdbFile::Find::kByNotes);
        if (!leaves) return std::nullopt;
        auto stream = StreamColumns::read(*leaves, header, where);
        if (!stream) return std::nullopt;
        columns = std::make_unique<StreamColumns>(std::move(*stream));
        worldFromIndexOf(leaves->transform(), where);
        volume = describe(header, metadata, leaves->transform(), where);
    } catch (const Error& error) {
        // Reading the grid as a whole reports the error.
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
    std::optional<DecodedBlocks> decoded = decodeBlocks(*columns, header, where, listener);
    if (!decoded) return std::nullopt;
    fillVolume(header, std::make_shared<const CodeTree>(std::move(decoded->blocks)),
               std::move(decoded->histogram), decoded->active, volume);
    if (volume.activeCount != header.active) return std::nullopt;
    return volume;
}

}  // namespace deltasplat
