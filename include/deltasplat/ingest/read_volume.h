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

/// The format of a .raw or .raw.gz file. Empty members are read from the file's name
/// (`engine_256x256x128_uint8.raw.gz`, `tooth_103x94x161_uint16be.raw`).
struct RawFormat {
    std::optional<glm::i64vec3> dims;  ///< voxels along x (fastest), y, z; each at least 1
    std::optional<std::string> type;   ///< uint8 int8 uint16 int16 uint32 int32 float32 float64
    std::optional<bool> bigEndian;     ///< default: little, or what the name says
    /// World units per voxel, each 1e-15..1e15; also of images. Empty: 1, or an image's own.
    std::optional<glm::dvec3> spacing;
    glm::dvec3 origin{0.0};  ///< world position of the centre of voxel (0,0,0), within 1e15 of the
                             ///< world's; also of images
    std::uint64_t skipBytes = 0;  ///< header bytes to skip (after decompression)
};

/// How a level set will be shown as a surface (Surface).
struct LevelSetSurface {
    double isovalue = 0;   ///< in data units
    bool isSolid = false;  ///< the inside is needed too, because it may be cut
};

struct ReadOptions {
    /// .vdb: the grid to read, "" being a nameless one. Empty: `density`, else the first fog
    /// volume, else the first other scalar grid, `phi` and solvers' helpers ("phi_obstacle",
    /// "flags", "shadow", ...) last; an error if that grid cannot be read.
    std::optional<std::string> gridName = {};
    bool levelSetToFog = true;  ///< .vdb: turn level sets into fog volumes; without a background
                                ///< above 0 they are kept, with a warning
    /// .vdb: kept level sets get active voxels, continuing their values, if their band ends too
    /// near to this surface on a side, with a warning. Inactive negative voxels are inside.
    std::optional<LevelSetSurface> levelSetSurface = {};
    std::optional<double> nanValue;  ///< replaces NaN and infinities; empty: error
    RawFormat raw;
    /// NIfTI, MetaImage and .npy of more than three axes: number of the volume, from 0 on; the
    /// fourth axis is the fastest (in C-ordered .npy the fourth from last). Empty: the file must
    /// have one. TIFF of ImageJ or OME-XML: number of channel and time, channels fastest. Layered
    /// segmentations of 3D Slicer: number of the layer; empty: all, each voxel with the topmost
    /// label in Slicer. No effect on other formats.
    std::optional<std::int64_t> volume;
    /// DICOM only: UID of the series to read. Empty: the file must have one.
    std::optional<std::string> series;
    /// Real values: a linear code book of 2^bits codes, 8..16. Empty: an exact book if there is one
    /// (at most 65536 different values), otherwise one with errors up to 2e-4 of each value, and of
    /// its neighbours' range, as far as 65536 codes allow (src/volume/fitted_book.h).
    std::optional<int> bits;
    /// More than 65536 different values: keep each within this share (0..1, exclusive) of its
    /// magnitude, a quarter of it if possible. Empty, or if 65536 codes do not suffice: no effect.
    std::optional<double> relativeError;
    /// Palette images: whether to read palette numbers, as labels are stored, or the colours'
    /// luminance. Empty: the luminance, with a note; for ImageJ's display palettes, the numbers.
    std::optional<bool> paletteNumbers;
    bool keepSource = false;  ///< fill Volume::source
    /// Fill Volume::source where the code book is not exact, for X-rays and largest values.
    bool keepInexact = false;
    /// Read voxels of a plain raw file (.raw, .npy, .nii of 8- and 16-bit whole numbers) on demand:
    /// partial pictures take less time and memory. The file stays open and must not change, or the
    /// request throws Error(kInput). Packed delta grids are read at once but unpacked on demand:
    /// requests find damage and throw. Useless for reading all voxels; no effect with keepSource.
    bool readLater = false;
    /// With readLater: whether voxels of a value, in a volume of this Volume::type, will probably
    /// be requested. They are then read during the first pass over the file. Null: unknown.
    std::function<bool(const std::string& type, double value)> isWanted = nullptr;
    /// Memory that the caller will take per 8x8x8 block that is not uniform, for setMemoryLimit():
    /// volumes that are too large are refused before they are read.
    double bytesPerBlock = 0;
    double bytesPerInexactBlock =
        0;  ///< additional, if codes are not exact; twice for 8-byte values
};

/// Reads one scalar volume by extension, in any case: `.vdb .raw .npy .nii .hdr .nrrd .nhdr .mhd
/// .mha .dcm` and images (`.tif .png .jpg .bmp .pgm .exr`, pages are slices). All but DICOM and
/// images may be gzipped, which is found by content (.raw, .raw.gz: by name). Also reads a folder
/// of DICOM slices or of images, and a stack `slice.####.png` or `slice.%04d.png`. Packed DICOM
/// needs a build with GDCM (deltasplat-helper). Skipped content causes a warning.
/// Level sets and NaN are treated by `options`. Only active values of a .vdb count; a NaN
/// background becomes `nanValue` or 0, with a warning. An empty grid is a valid, empty volume, with
/// a warning. Deterministic, whatever the number of threads.
/// @throw Error(kInput) if the file is missing, truncated, of the wrong size or not what it claims;
///        Error(kUsage) for impossible options (zero dims, an overflow, an unknown type);
///        Error(kFailed) if memory does not suffice; whatever `listener.progress` throws
Volume readVolume(const std::filesystem::path& file, const ReadOptions& options = {},
                  const Listener& listener = {});

/// What forEachVolume reports. Each member may be left empty.
struct VolumeVisitor {
    std::function<void(Volume)> volume;  ///< a scalar grid
    /// An invalid scalar grid; reading goes on. Empty: the error is thrown.
    std::function<void(const Error&)> invalid;
    /// Name and value type of a grid that is not scalar, or of a scalar grid skipped among others:
    /// a level set with NaN or infinite values or, without `invalid`, an unreadable frustum.
    std::function<void(const std::string& name, const std::string& type)> other;
};

/// Reads the scalar grids of a file one after the other, with only one in memory: a .vdb's grids in
/// file order, or only `options.gridName`; one volume of other formats.
/// @throw as readVolume, for problems of the whole file
void forEachVolume(const std::filesystem::path& file, const ReadOptions& options,
                   const VolumeVisitor& visitor, const Listener& listener = {});

/// Reads every scalar grid of a file, as forEachVolume finds them.
/// @throw as readVolume
std::vector<Volume> readAllVolumes(const std::filesystem::path& file,
                                   const ReadOptions& options = {}, const Listener& listener = {});

}  // namespace deltasplat
