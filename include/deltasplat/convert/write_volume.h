// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

struct WriteOptions {
    bool fullFloat = false;  ///< .vdb: never store real values as halves
    /// .vdb: keep the metadata's precision for real values of a volume's own grid, not exact
    /// halves.
    bool keepPrecision = false;
    /// .vdb: make voxels of the value `background`, the grid's background, inactive.
    bool dropBackground = false;
    /// Empty: the volume's background, or its most frequent value (without an exact code book: of
    /// the voxels with the most frequent code) if guessBackground finds one.
    std::optional<double> background;
};

struct WriteReport {
    /// One line per detail that the file states differently, or not at all.
    std::vector<std::string> notes;
    /// Every value, active state, place, name and metadata can be read back.
    bool lossless = true;
    /// Largest error of a written value, over all voxels.
    double maxError = 0;
    std::vector<std::filesystem::path> files;
};

/// Returns the file for the voxels of a header file: `head.raw` for `head.mhd`, `head.raw.gz` for
/// `head.nhdr`; empty for formats of one file.
std::filesystem::path dataFileOf(const std::filesystem::path& file);

/// Checks the extension, and that the files can be written, before there is a volume.
/// @throw Error(kUsage) for an unknown extension or a name that the format cannot hold,
///        Error(kOutput) if a file cannot be written
void checkVolumeFile(const std::filesystem::path& file);

/// Writes volumes in the format that the file's extension names (in any case):
/// - `.vdb`: any number of volumes, Blosc-compressed, in half precision where that is exact. A
///   volume with a source writes that grid: values, active states, transform, class and metadata.
///   Other volumes get a float grid where floats hold every value, else int32 or double, with the
///   metadata `deltasplat_source_type`, `deltasplat_box_min`, `deltasplat_box_max`,
///   `deltasplat_space`, `deltasplat_length_unit` and `deltasplat_labels` about the volume.
/// - `.nrrd`, `.nhdr` (gzip inside), `.mhd`, `.mha`, `.nii`, `.nii.gz`, `.raw`, `.raw.gz`: one
///   volume, every voxel of its box (or of the metadata's box, if that holds it), little endian, x
///   fastest. Voxels keep their type (`deltasplat_source_type` if that holds every value); inactive
///   ones keep their value. World space is LPS in MetaImage and RAS in NIfTI, in millimetres if the
///   unit is known; a volume with empty `space` and `lengthUnit` keeps its numbers. NRRD stores
///   label names (segments of 3D Slicer); NRRD, MetaImage and NIfTI store that values are labels.
///
/// Files appear only when they are whole. Values come from Volume::source, if it is there (`codes`
/// may then be empty), else from the codes. Takes memory for a few slices, and for .vdb that of the
/// grids, beyond the volumes' own. Deterministic, whatever the number of threads.
/// @param volumes  taken to free codes early
/// @throw Error(kUsage) as checkVolumeFile, or for several volumes in a dense format;
///        Error(kFailed) for more than memory holds; Error(kInput) without active voxels in a dense
///        format; Error(kOutput) if writing fails; whatever `listener.progress` throws
WriteReport writeVolumes(const std::filesystem::path& file, std::vector<Volume> volumes,
                         const WriteOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
