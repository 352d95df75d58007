// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/read_volume.h"

#include <openvdb/Grid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/value_statistics.h"
#include "formats/delta/delta_format.h"
#include "formats/dense/dense_source.h"
#include "formats/dicom/dicom_sniff.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"
#include "formats/nifti/read_nifti.h"
#include "formats/readers.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/vdb_file.h"

namespace deltasplat {

namespace {

void read(const std::filesystem::path& file, const ReadOptions& options, bool all,
          const VolumeVisitor& visitor, const Listener& listener,
          decltype(&readDense) readValues = &readDense) {
    const DefaultFloats floats;
    requireFiniteNan(options);
    const InputKind kind = findInput(file, listener);
    if (inputsAreConfined()) requireConfined(file);
    if (kind.is(vdbFormat())) {
        readVdb(file, options, all, visitor, listener);
    } else {
        Volume volume =
            readValues(kind.format->open(file, kind, options, listener), options, listener);
        if (visitor.volume) visitor.volume(std::move(volume));
    }
    listener.report(1);
}

std::vector<Volume> collect(const std::filesystem::path& file, const ReadOptions& options, bool all,
                            const Listener& listener,
                            decltype(&readDense) readValues = &readDense) {
    std::vector<Volume> volumes;
    VolumeVisitor visitor;
    visitor.volume = [&](Volume volume) { volumes.push_back(std::move(volume)); };
    read(file, options, all, visitor, listener, readValues);
    return volumes;
}

}  // namespace

Volume readVolume(const std::filesystem::path& file, const ReadOptions& options,
                  const Listener& listener) {
    return std::move(collect(file, options, false, listener).front());
}

Volume readCompared(const std::filesystem::path& file, const ReadOptions& options,
                    const Listener& listener) {
    return std::move(collect(file, options, false, listener, &readDenseUnsigned).front());
}

int placeDigitsOf(const std::filesystem::path& file) {
    if (!findInput(file, {}).is(niftiFormat())) return std::numeric_limits<double>::digits;
    return readNiftiHeader(file, {}).placeDigits;
}

std::vector<Volume> readAllVolumes(const std::filesystem::path& file, const ReadOptions& options,
                                   const Listener& listener) {
    return collect(file, options, true, listener);
}

void forEachVolume(const std::filesystem::path& file, const ReadOptions& options,
                   const VolumeVisitor& visitor, const Listener& listener) {
    read(file, options, true, visitor, listener);
}

namespace {

// The box that OpenVDB writes into a grid's metadata.
std::optional<IndexBox> notedBox(const VdbMetadata& metadata) {
    const auto min = metadata.get<glm::ivec3>(openvdb::GridBase::META_FILE_BBOX_MIN);
    const auto max = metadata.get<glm::ivec3>(openvdb::GridBase::META_FILE_BBOX_MAX);
    if (!min || !max) return {};
    const IndexBox box{*min, *max};
    return box.empty() ? IndexBox() : box;
}

void addMetadata(const VdbMetadata& metadata, const VdbGrid& grid, const std::string& where,
                 VolumeEntry& entry) {
    entry.gridClass = metadata.text(openvdb::GridBase::META_GRID_CLASS);
    entry.box = notedBox(metadata);
    if (!isDeltaGrid(grid.type, metadata)) return;
    entry.delta = true;
    const DeltaHeader header = takeDeltaHeader(metadata, where);
    entry.type = header.sourceType;
    entry.gridClass.clear();
    entry.box = header.box;
}

std::vector<VolumeEntry> listVdb(const std::filesystem::path& path) {
    const VdbFile file(path);
    const VdbGrid* const preferred = toldDefaultGrid(file);
    std::vector<VolumeEntry> entries;
    VdbBytes bytes = file.bytes();
    for (const VdbGrid& grid : file.grids()) {
        VolumeEntry entry;
        entry.name = grid.name;
        entry.type = grid.valueType();
        entry.scalar = grid.isScalar();
        entry.preferred = &grid == preferred;
        try {
            const VdbFile::Summary summary = file.summary(grid, bytes);
            entry.obstacle = summary.obstacle;
            if (!entry.obstacle.empty()) entry.scalar = false;
            addMetadata(summary.metadata, grid, path.string(), entry);
        } catch (const Error&) {
            // A bad grid is reported when it is read; other grids remain usable.
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

void describe(const DenseSource& source, VolumeEntry& entry) {
    entry.name = source.name;
    entry.type = rawTypeName(source.valueType());
    entry.box = IndexBox{glm::ivec3(0), glm::ivec3(source.dims) - 1};
    entry.volumes = source.volumes;
}

// A bad series among several is reported when it is read.
void describe(const std::filesystem::path& input, const std::string& name, DicomSeries series,
              bool alone, VolumeEntry& entry) {
    entry.name = name;
    entry.type = series.images ? "unknown" : kNoImages;
    entry.series = series.uid;
    entry.description = series.description;
    try {
        describe(openDicom(input, name, std::move(series)), entry);
    } catch (const Error& error) {
        if (alone || error.code() != ErrorCode::kInput) throw;
        entry.scalar = false;
    }
}

std::vector<VolumeEntry> listDicom(const std::filesystem::path& input, const InputKind& kind,
                                   const ReadOptions& options) {
    std::vector<DicomSeries> all = findSeries(input, kind.files);
    const bool alone = all.size() == 1;
    if (options.series) all = {chooseSeries(input, std::move(all), options.series)};
    std::vector<VolumeEntry> entries(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        describe(input, kind.name, std::move(all[i]), all.size() == 1, entries[i]);
        entries[i].preferred = alone;
    }
    return entries;
}

}  // namespace

std::vector<VolumeEntry> listVolumes(const std::filesystem::path& file, const ReadOptions& options,
                                     const Listener& listener) {
    const InputKind kind = findInput(file, listener);
    if (inputsAreConfined()) requireConfined(file);
    if (kind.is(vdbFormat())) return listVdb(file);
    if (kind.is(dicomFormat())) return listDicom(file, kind, options);
    ReadOptions any = options;
    if (!any.volume) any.volume = 0;
    VolumeEntry entry;
    describe(kind.format->open(file, kind, any, listener), entry);
    entry.preferred = entry.volumes == 1;
    return {entry};
}

}  // namespace deltasplat
