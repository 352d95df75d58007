// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/delta/delta_file.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/error.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/read_delta_grid.h"
#include "formats/delta/stream_writer.h"
#include "formats/delta/take_deltas.h"
#include "formats/delta/word_tree.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/volume_grid.h"
#include "formats/vdb/write_vdb.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

void checkTolerance(const std::string& option, double tolerance) {
    if (std::isfinite(tolerance) && tolerance >= 0) return;
    throw Error(ErrorCode::kUsage, option, numberText(tolerance), "a number >= 0");
}

// Requires a tolerance of at least the code book's own errors.
void requireRoom(const Tolerance& tolerance, const Volume& volume) {
    const CodeBook& book = volume.codeBook();
    if (book.isExact() || tolerance.isExact()) return;
    double codeError = 0;
    for (int code = 0; code < kCodeCount; ++code) {
        if (volume.histogram()[std::size_t(code)] > 0)
            codeError = std::max(codeError, book.largestErrorOf(Code(code)));
    }
    const auto refuse = [&](const char* option, double got, const std::string& expected) {
        throw Error(ErrorCode::kUsage, option, numberText(got),
                    expected + ": values are stored with errors up to " + numberText(codeError) +
                        " (" + book.name() + " code book)");
    };
    if (tolerance.value > 0 && tolerance.value < codeError) {
        refuse("`tolerance.value`", tolerance.value,
               "at least " + numberText(codeError) +
                   (tolerance.relative > 0 ? " with `tolerance.relative`, any without" : ""));
    }
    if (tolerance.relative > 0 && book.relativeError == 0)
        refuse("`tolerance.relative`", tolerance.relative,
               "a larger share, or `tolerance.value`, for these values");
    if (tolerance.relative > 0 && tolerance.relative < book.relativeError)
        refuse("`tolerance.relative`", tolerance.relative,
               "at least " + numberText(book.relativeError));
}

// Copies the source's metadata under prefixed names, without the keys that writers set anew.
void putSourceMetadata(const VdbMetadata& source, VdbMetadata& metadata) {
    const auto noted = fileMetadata();
    for (const auto& [name, entry] : source.entries()) {
        const bool isNoted = std::find(noted.begin(), noted.end(), name) != noted.end();
        if (!isNoted) metadata.insert(kSourcePrefix + name, entry);
    }
}

openvdb::math::MapBase::Ptr permutedMap(const glm::dmat4& worldFromIndex, int sliceAxis) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    glm::dmat4 permuted = worldFromIndex;
    for (int axis = 0; axis < 3; ++axis) permuted[axis] = worldFromIndex[order[axis]];
    return makeMap(permuted);
}

}  // namespace

struct DeltaFile::Impl {
    std::vector<WrittenGrid> grids;
    VdbMetadata fileMetadata;
};

DeltaFile::DeltaFile() : impl_(std::make_unique<Impl>()) {}

DeltaFile::~DeltaFile() = default;

DeltaFileEntry DeltaFile::add(const Volume& volume, const DeltaFileOptions& options,
                              const Listener& listener) {
    const DefaultFloats floats;
    checkTolerance("`tolerance.relative`", options.tolerance.relative);
    checkTolerance("`tolerance.value`", options.tolerance.value);
    requireRoom(options.tolerance, volume);

    const std::optional<Volume> scaled =
        hasMap(volume.worldFromIndex()) ? std::nullopt : std::optional(withHoldableUnit(volume));
    const glm::dmat4& worldFromIndex = (scaled ? *scaled : volume).worldFromIndex();
    const std::string& lengthUnit = (scaled ? *scaled : volume).lengthUnit();
    const TreeGrid* const source = volume.source() ? &volume.source()->grid : nullptr;
    TakenDeltas taken = takeDeltas(volume, options, partOf(listener, 0, 0.6));
    DeltaHeader& header = taken.header;
    const InactiveValues& inactive = taken.inactive;
    TreeGrid grid{std::exchange(taken.deltas, nullptr), {}};
    if (options.pack) grid.tree = treeOfWords(streamOf(*grid.tree, header));
    listener.report(0.7);
    if (source && volume.hasBackground()) {
        header.sourceTree = source->type();
        header.sourceMap = source->map->type();
        putSourceMetadata(source->metadata, grid.metadata);
        if (impl_->grids.empty()) impl_->fileMetadata = volume.source()->fileMetadata;
    }
    grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, volume.name());
    grid.metadata.insert(openvdb::GridBase::META_GRID_CREATOR, std::string("deltasplat"));
    if (!lengthUnit.empty()) grid.metadata.insert(kLengthUnitKey, lengthUnit);
    if (volume.labels()) grid.metadata.insert(kLabelsKey, labelText(*volume.labels()));
    grid.map = permutedMap(worldFromIndex, header.sliceAxis);
    putDeltaHeader(header, grid.metadata);

    DeltaFileEntry entry;
    entry.sliceAxis = header.sliceAxis;
    entry.keyInterval = header.keyInterval;
    entry.deltas = header.deltas();
    entry.codeBook = header.bookName();
    if (header.exact || !volume.codeBook().isExact() || !options.tolerance.isExact()) {
        // Measures the real error: restores the volume and compares it with the source.
        ReadOptions reading;
        reading.levelSetToFog = false;
        reading.keepSource = true;
        const Volume restored(readDeltaGrid(grid, {}, volume.name(), reading, {}));
        entry.maxError = compareVolumes(restored, volume).maxError;
        header.maxError += entry.maxError;
        putDeltaHeader(header, grid.metadata);
    }
    entry.maxError = header.maxError;
    entry.lossless = entry.maxError == 0 && !inactive.tooMany && !inactive.rounded;
    if (inactive.rounded)
        listener.warn("grid \"" + volume.name() +
                      "\": the background, or what is inactive, has whole numbers beyond 2^53, "
                      "which are rounded");
    if (inactive.tooMany)
        listener.warn("grid \"" + volume.name() +
                      "\": more than 65536 different values of inactive voxels; they become the "
                      "background");
    if (options.maxError && entry.maxError > *options.maxError) {
        throw Error(ErrorCode::kFailed, "grid \"" + volume.name() + "\"",
                    "a largest error of " + numberText(entry.maxError),
                    "at most " + numberText(*options.maxError) + " (`maxError`)");
    }
    impl_->grids.push_back(options.pack ? writtenWords(grid) : writtenDeltas(grid));
    listener.report(1);
    return entry;
}

void DeltaFile::write(const std::filesystem::path& file) const {
    writeVdb(file, impl_->grids, impl_->fileMetadata);
}

}  // namespace deltasplat
