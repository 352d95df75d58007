// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/write_grids.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/value_statistics.h"
#include "formats/dense/dense_layout.h"
#include "formats/vdb/drop_background.h"
#include "formats/vdb/volume_grid.h"
#include "formats/vdb/write_vdb.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

// Share of the progress for making grids; compressing and writing takes longer.
constexpr double kGridShare = 0.3;

std::string quoted(const std::string& name) {
    return "grid \"" + name + "\"";
}

// Returns the value to drop, or nothing if no value stands out.
std::optional<double> droppedValue(const Volume& volume, const WriteOptions& options) {
    if (options.background) return options.background;
    if (volume.hasBackground()) return volume.background();
    if (!guessBackground(volume)) return {};
    return mostFrequentValue(volume);
}

// Requires a background that the grid's type can hold.
void requireValue(const std::string& type, double value) {
    bool holds = true;
    if (type == "float") holds = std::abs(value) <= double(std::numeric_limits<float>::max());
    if (type == "int32" || type == "int64") holds = value == std::floor(value);
    if (type == "int32") holds = holds && value >= -0x1p31 && value < 0x1p31;
    if (type == "int64") holds = holds && value >= -0x1p63 && value < 0x1p63;
    if (type == "bool" || type == "mask") holds = value == 0 || value == 1;
    if (holds) return;
    throw Error(ErrorCode::kUsage, "`background`", numberText(value), "a value of type " + type);
}

// Returns the value to drop, or remarks that there is none.
std::optional<double> valueToDrop(const Volume& volume, const WriteOptions& options,
                                  WriteNotes& notes) {
    const std::optional<double> dropped = droppedValue(volume, options);
    if (!dropped) {
        notes.remark(
            "`dropBackground`: no value is frequent enough to be one; every voxel stays active");
    }
    return dropped;
}

TreeGrid sparseGrid(const TreeGrid& grid, const Volume& volume, const WriteOptions& options,
                    WriteNotes& notes) {
    const std::optional<double> dropped = valueToDrop(volume, options, notes);
    if (!dropped) return grid;
    const double value = *dropped;
    // Another background would change the value of existing inactive voxels.
    if (volume.hasBackground() && value != volume.background()) {
        notes.remark("`background`: has no effect on " + quoted(volume.name()) +
                     ", whose background is " + numberText(volume.background()));
        return grid;
    }
    requireValue(grid.type(), value);
    TreeGrid sparse = dropBackground(grid, value);
    const std::uint64_t kept = sparse.tree->activeVoxelCount();
    if (volume.hasBackground() && kept != volume.activeCount()) {
        notes.loss(quoted(volume.name()) + ": " +
                   countText(volume.activeCount() - kept, "active voxel") + " of value " +
                   numberText(value) + " made inactive");
    }
    return sparse;
}

// Remarks the type in which a volume without OpenVDB's types is stored, if its name differs.
void noteType(const Volume& volume, const std::string& type, bool half, WriteNotes& notes) {
    const bool same = volume.type() == type || (volume.type() == "float32" && type == "float") ||
                      (volume.type() == "float64" && type == "double");
    // Inexact reading has been reported before.
    if (volume.hasBackground() || same || volume.readError() > 0) return;
    notes.remark(volume.type() + " stored as " + (half ? "half" : type) +
                 ", which holds every value");
}

// Returns a volume that has only codes ready for writing. No tree of values is made.
WrittenGrid storedCodes(Volume volume, const WriteOptions& options, WriteNotes& notes) {
    const std::string type = gridTypeOf(volume);
    double background = volume.hasBackground() ? volume.background() : 0;
    if (options.dropBackground) {
        if (const auto dropped = valueToDrop(volume, options, notes)) {
            requireValue(type, *dropped);
            dropBackground(volume, *dropped, type);
            background = *dropped;
        }
    }
    const bool half = !options.fullFloat && survivesHalf(volume, type, background);
    noteType(volume, type, half, notes);
    WrittenGrid grid = writtenCodes(volume, type, background);
    grid.metadata.insert(openvdb::GridBase::META_SAVE_HALF_FLOAT, half);
    return grid;
}

// Returns the grid ready for writing: sparser if that is asked for, in half precision or not.
WrittenGrid storedGrid(Volume volume, const WriteOptions& options, WriteNotes& notes) {
    if (!volume.source() && !(volume.hasBackground() && options.dropBackground))
        return storedCodes(std::move(volume), options, notes);
    TreeGrid grid = gridOf(volume);
    volume = volume.withoutCodes();
    if (options.dropBackground) grid = sparseGrid(grid, volume, options, notes);

    if (options.keepPrecision && volume.source() && volume.hasBackground())
        return writtenGrid(grid);
    const bool half = !options.fullFloat && survivesHalf(grid, &volume);
    noteType(volume, grid.type(), half, notes);
    WrittenGrid written = writtenGrid(grid);
    written.metadata.insert(openvdb::GridBase::META_SAVE_HALF_FLOAT, half);
    return written;
}

// Merges the metadata of all volumes' files; of equal keys the first wins.
VdbMetadata fileMetadata(const std::vector<Volume>& volumes) {
    VdbMetadata all;
    for (const Volume& volume : volumes) {
        if (!volume.source()) continue;
        for (const auto& [name, entry] : volume.source()->fileMetadata.entries()) {
            if (!all.find(name)) all.insert(name, entry);
        }
    }
    return all;
}

}  // namespace

WriteReport writeGrids(const std::filesystem::path& file, std::vector<Volume> volumes,
                       const WriteOptions& options, const Listener& listener) {
    WriteReport report;
    WriteNotes notes(report, file);
    const VdbMetadata metadata = fileMetadata(volumes);
    std::vector<WrittenGrid> grids;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        Volume volume = withHoldableUnit(std::move(volumes[i]));
        grids.push_back(storedGrid(std::move(volume), options, notes));
        listener.report(kGridShare * double(i + 1) / double(volumes.size()));
    }
    Listener writing = listener;
    writing.progress = [&](double share) {
        listener.report(kGridShare + (1 - kGridShare) * share);
    };
    writeVdb(file, grids, metadata, writing);
    report.files = {file};
    return report;
}

}  // namespace deltasplat
