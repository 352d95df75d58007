// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// How a .raw or .raw.gz file is to be understood. Members left empty are read from the file's name
/// (`engine_256x256x128_uint8.raw.gz`, `tooth_103x94x161_uint16be.raw`).
struct RawFormat {
    std::optional<glm::i64vec3> dims;  ///< voxels along x (fastest), y, z; each at least 1
    std::optional<std::string> type;   ///< uint8 int8 uint16 int16 uint32 int32 float32 float64
    std::optional<bool> bigEndian;     ///< default: little, or what the name says
    /// World units per voxel, each 1e-15..1e15; images too. Empty: 1, or what an image says.
    std::optional<glm::dvec3> spacing;
    glm::dvec3 origin{0.0};       ///< world position of the centre of voxel (0,0,0), within 1e15 of
                                  ///< the world's; images too
    std::uint64_t skipBytes = 0;  ///< header bytes to pass over (after decompression)
};

/// What is going to be shown of a level set as a surface (Surface).
struct LevelSetSurface {
    double isovalue = 0;   ///< in data units
    bool isSolid = false;  ///< what is inside is wanted as well, for it may be cut
};

/// How to read a volume.
struct ReadOptions {
    /// .vdb: which grid, "" being one without a name. Empty: `density`, else the first fog volume,
    /// else the first other scalar grid, `phi` and those that help solvers ("phi_obstacle",
    /// "flags", "shadow", ...) last; an error if that cannot be read.
    std::optional<std::string> gridName = {};
    bool levelSetToFog = true;  ///< .vdb: turn level sets into fog volumes; one whose
                                ///< background is not above 0 is kept, with a warning
    /// .vdb: level sets that stay what they are get active voxels beside this surface where their
    /// band ends too near to it on either side, as its values go on, with a warning. What is not
    /// active and negative is inside. Empty: nothing becomes active.
    std::optional<LevelSetSurface> levelSetSurface = {};
    std::optional<double> nanValue;  ///< replaces NaN and infinities; empty: they are an error
    RawFormat raw;                   ///< .raw: what the bytes are
    /// NIfTI, MetaImage and .npy of more than three axes: which of their volumes, from 0 on; the
    /// fourth axis counts fastest (of a C-ordered .npy the one before the last three). Empty: there
    /// has to be one. TIFF that ImageJ or OME-XML describes: which of its channels and times,
    /// channels counting fastest. Of a segmentation of 3D Slicer in layers: which layer; empty: all
    /// of them, a voxel having the label that Slicer shows on top. Other formats pay no heed to it.
    std::optional<std::int64_t> volume;
    /// DICOM: the UID of the series to read. Empty: there has to be one. Other formats pay no heed
    /// to it.
    std::optional<std::string> series;
    /// Real values: a linear code book of 2^bits codes, 8..16. Empty: an exact book if there is
    /// one (at most 65536 different values), otherwise one that keeps every value within 2e-4 of
    /// itself, and of its neighbours' range, as far as 65536 codes allow
    /// (src/volume/fitted_book.h).
    std::optional<int> bits;
    /// Values of more than 65536 kinds: each kept within this share (0..1, exclusive) of its
    /// magnitude (a quarter of it, if possible), where 65536 codes are enough for that. Empty, or
    /// not enough: as without it.
    std::optional<double> relativeError;
    /// Images whose pixels are numbers of a palette's colours: whether these numbers are read, as
    /// labels are kept, or the luminance of the colours. Empty: the luminance, which is said, but
    /// of ImageJ's, whose palettes are how values are shown, the numbers.
    std::optional<bool> paletteNumbers;
    bool keepSource = false;  ///< fill Volume::source
    /// Fill Volume::source where the code book is not exact: what X-rays and largest values read.
    bool keepInexact = false;
    /// Read voxels of a plain raw file (.raw, .npy, .nii of whole numbers of 8 and 16 bits) when
    /// they are first asked for: a picture of some of them takes less time and memory. The file
    /// stays open and must stay as it is: else what asks throws Error(kInput). Packed delta grids,
    /// whose file is read at once, are unpacked so: damage is found, and thrown, by who asks. Of no
    /// use where all voxels are asked for, and without effect with keepSource.
    bool readLater = false;
    /// With readLater: whether voxels of a value will probably be asked for, where a volume has
    /// such a Volume::type. They are then read while the file is gone over anyway. Null: nobody
    /// knows.
    std::function<bool(const std::string& type, double value)> isWanted = nullptr;
    /// What the caller will take besides for each 8x8x8 block that is not uniform: counts where
    /// setMemoryLimit() is in force, so that too large a volume is refused before it is read.
    double bytesPerBlock = 0;
    double bytesPerInexactBlock = 0;  ///< besides, if codes are not exact; twice of 8-byte values
};

/// Reads one scalar volume: `.vdb .raw .npy .nii .hdr .nrrd .nhdr .mhd .mha .dcm` and images
/// (`.tif .png .jpg .bmp .pgm .exr`, of which pages are slices) by extension, in any case, all but
/// DICOM and images also under gzip, which is found by content (.raw, .raw.gz: by name); a
/// folder of DICOM slices or of images; a stack `slice.####.png` or `slice.%04d.png`. Packed
/// DICOM needs a build with GDCM (deltasplat-helper). What is passed over is said in a warning.
/// Level sets and NaN are treated as `options` says; only active values of a .vdb count, a NaN
/// background is taken as `nanValue` or 0, with a warning. An empty grid is a valid, empty volume,
/// with a warning. Deterministic; not affected by the number of threads.
/// @throw Error(kInput) if the file is missing, truncated, of the wrong size or not what it claims;
///        Error(kUsage) if the options cannot be meant (zero dims, an overflow, an unknown type);
///        Error(kFailed) if the volume does not fit into memory; whatever `listener.progress`
///        throws
Volume readVolume(const std::filesystem::path& file, const ReadOptions& options = {},
                  const Listener& listener = {});

/// What forEachVolume hands over. Each member may be left empty.
struct VolumeVisitor {
    std::function<void(Volume)> volume;  ///< a scalar grid
    /// A scalar grid that is no valid volume; the others follow. Empty: the error is thrown.
    std::function<void(const Error&)> invalid;
    /// Name and value type of a grid that is not scalar. Also of one among other scalar grids that
    /// is passed over like those: a level set with NaN or infinite values, and, unless `invalid` is
    /// there, one of a kind that is not read (a frustum).
    std::function<void(const std::string& name, const std::string& type)> other;
};

/// Reads the scalar grids of a file one after the other, so that only one is in memory: one volume
/// for all but .vdb; a .vdb's grids in file order, or only that of `options.gridName`.
/// @throw as readVolume, for what concerns the whole file
void forEachVolume(const std::filesystem::path& file, const ReadOptions& options,
                   const VolumeVisitor& visitor, const Listener& listener = {});

/// Reads every scalar grid of a file, as forEachVolume finds them.
/// @throw as readVolume
std::vector<Volume> readAllVolumes(const std::filesystem::path& file,
                                   const ReadOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
