// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Names of the grids of a .vdb file, in file order.
struct GridList {
    std::vector<std::string> scalar;       ///< as ReadOptions::gridName takes them
    std::optional<std::string> preferred;  ///< the one read by default, if it can be
    std::vector<std::string> others;       ///< with their types, as "velocity (vec3s)"
    std::vector<std::string> deltas;       ///< of the scalar ones, those that are delta grids
    /// All that are no delta grids, with their types.
    std::vector<std::string> ordinary;
};

/// Lists the grids of a .vdb file without reading their voxels.
/// @throw Error(kInput) if the file is missing or no whole .vdb file
GridList listGrids(const std::filesystem::path& file);

/// The type of a DICOM series without images, as reports have it.
inline constexpr const char* kNoImages = "no images";

/// What the headers of a file say about one volume in it.
struct VolumeEntry {
    std::string name;             ///< as ReadOptions::gridName takes it, where there are grids
    std::string type;             ///< as Volume::type; of a delta grid, that of its source; of a
                                  ///< DICOM series that cannot be read "unknown" or kNoImages
    std::string gridClass;        ///< as Volume::gridClass; "" where none is said
    std::optional<IndexBox> box;  ///< of its active voxels; empty optional where it is not said
    bool scalar = true;           ///< whether it can be read
    std::string obstacle;    ///< .vdb: why a grid of numbers cannot be read ("type uint32"); or
                             ///< empty
    bool delta = false;      ///< whether it is a delta grid
    bool preferred = false;  ///< whether it is the one read by default
    std::optional<std::string> series;  ///< DICOM: as ReadOptions::series takes it
    std::string description;            ///< DICOM: what the series is said to be; or empty
    /// NIfTI and .npy: this volume stands for so many, which differ in their values alone; as
    /// ReadOptions::volume counts them.
    std::int64_t volumes = 1;
};

/// Lists what is in a file that readVolume reads, voxels unread: every grid of a .vdb, every series
/// of DICOM (unless options.series is one), of other formats one volume. A series of several that
/// cannot be read has no box and is not scalar: what is wrong is said when it is read.
/// @throw as readVolume, as far as headers go
std::vector<VolumeEntry> listVolumes(const std::filesystem::path& file,
                                     const ReadOptions& options = {},
                                     const Listener& listener = {});

/// The grids of a .vdb that are fire and colour by their names; empty where there are none.
struct MediumGrids {
    std::string emission;
    std::string color;
    /// The next of fire, where headers do not say that it has no active voxels.
    std::string otherEmission;
};

/// Returns which grids their names, whatever their case, tell: of flame, flames, fire, burn, heat,
/// temperature the first that is scalar, and of Cd, color, colour, albedo the first of colours.
MediumGrids mediumGrids(const std::vector<VolumeEntry>& entries);

/// Whether values of a type are vectors of real numbers, as colours are.
bool isColorType(const std::string& type);

}  // namespace deltasplat
