// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// How to write volumes.
struct WriteOptions {
    bool fullFloat = false;  ///< .vdb: never store real values as halves
    /// .vdb: store real values of a volume's own grid in the precision that its metadata says,
    /// rather than as halves where that is exact.
    bool keepPrecision = false;
    /// .vdb: make active voxels inactive that have the value `background`, which becomes the grid's
    /// background.
    bool dropBackground = false;
    /// Empty: the background that the volume has; if it has none, its most frequent value (without
    /// an exact code book: of those with the fullest code) if guessBackground finds one.
    std::optional<double> background;
};

/// What became of volumes that were written.
struct WriteReport {
    /// One line for each detail that the file says otherwise, or not at all.
    std::vector<std::string> notes;
    /// Every value, active state, place, name and metadata can be read back.
    bool lossless = true;
    /// Largest difference between a voxel's value and the one written, over all voxels.
    double maxError = 0;
    std::vector<std::filesystem::path> files;  ///< what was written
};

/// Returns the file that goes with a header file to hold its voxels: `head.raw` for `head.mhd`,
/// `head.raw.gz` for `head.nhdr`; empty for formats of one file.
std::filesystem::path dataFileOf(const std::filesystem::path& file);

/// Checks what can be checked before there is a volume: the extension, and that the files can be
/// written.
/// @throw Error(kUsage) for an unknown extension or a name that the format cannot hold,
///        Error(kOutput) if a file cannot be written
void checkVolumeFile(const std::filesystem::path& file);

/// Writes volumes in the format that the file's extension names (in any case):
/// - `.vdb`: any number of volumes, Blosc-compressed, in half precision where that is exact. A
///   volume that has its source writes that grid: values, active states, transform, class and
///   metadata. Others get a float grid where floats hold every value (otherwise int32 or double)
///   whose metadata `deltasplat_source_type`, `deltasplat_box_min`, `deltasplat_box_max`,
///   `deltasplat_space`, `deltasplat_length_unit` and `deltasplat_labels` say what it was.
/// - `.nrrd`, `.nhdr` (gzip inside), `.mhd`, `.mha`, `.nii`, `.nii.gz`, `.raw`, `.raw.gz`: one
///   volume, every voxel of its box (or of the one in the metadata, if that holds it), little
///   endian, x fastest. Voxels keep their type (`deltasplat_source_type` if there is one and it
///   holds every value); inactive ones are written with the value they hold. World space is LPS in
///   MetaImage and RAS in NIfTI, as these formats have it, in millimetres where the unit is known;
///   a volume whose `space` and `lengthUnit` are empty keeps its numbers. Names of labels go into
///   NRRD (segments of 3D Slicer), that values are labels into MetaImage and NIfTI as well.
///
/// Files appear only when they are whole. Values come from Volume::source if it is there (`codes`
/// may then be empty), otherwise from the codes; memory for a few slices is needed beyond the
/// volumes' own, and for .vdb that of the grids. Deterministic, whatever the number of threads.
/// @param volumes  taken to be able to free codes once they are not needed
/// @throw Error(kUsage) as checkVolumeFile, for more than one volume in a dense format;
///        Error(kFailed) for more than memory holds; Error(kInput) if a dense format is asked for a
///        volume without active voxels; Error(kOutput) if a file cannot be written; whatever
///        `listener.progress` throws
WriteReport writeVolumes(const std::filesystem::path& file, std::vector<Volume> volumes,
                         const WriteOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
