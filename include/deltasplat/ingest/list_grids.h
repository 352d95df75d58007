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
    std::optional<std::string> preferred;  ///< the default grid, if it can be read
    std::vector<std::string> others;       ///< with their types, as "velocity (vec3s)"
    std::vector<std::string> deltas;       ///< scalar grids that are delta grids
    /// Grids that are no delta grids, with their types.
    std::vector<std::string> ordinary;
};

/// Lists the grids of a .vdb file without reading their voxels.
/// @throw Error(kInput) if the file is missing or no whole .vdb file
GridList listGrids(const std::filesystem::path& file);

/// Type of a DICOM series without images, in reports.
inline constexpr const char* kNoImages = "no images";

/// A volume as described by a file's headers.
struct VolumeEntry {
    std::string name;  ///< as ReadOptions::gridName takes it, if the format has grids
    std::string type;  ///< as Volume::type; of a delta grid, its source's; of an unreadable DICOM
                       ///< series "unknown" or kNoImages
    std::string gridClass;        ///< as Volume::gridClass; "" if unknown
    std::optional<IndexBox> box;  ///< of the active voxels; empty if unknown
    bool scalar = true;           ///< whether it can be read
    std::string obstacle;  ///< .vdb: why a grid of numbers cannot be read ("type uint32"), or empty
    bool delta = false;
    bool preferred = false;             ///< whether it is read by default
    std::optional<std::string> series;  ///< DICOM: as ReadOptions::series takes it
    std::string description;            ///< DICOM: the series' description, or empty
    /// NIfTI and .npy: volumes, counted as by ReadOptions::volume, that differ in values only.
    std::int64_t volumes = 1;
};

/// Lists the volumes of a file that readVolume reads, without voxels: every grid of a .vdb, every
/// series of DICOM (or options.series), one volume of other formats. An unreadable series among
/// several has no box and is not scalar; reading it gives the error.
/// @throw as readVolume, as far as headers go
std::vector<VolumeEntry> listVolumes(const std::filesystem::path& file,
                                     const ReadOptions& options = {},
                                     const Listener& listener = {});

/// Grids of a .vdb that are fire and colour by their names; empty: none.
struct MediumGrids {
    std::string emission;
    std::string color;
    /// The next grid of fire, unless headers say that it has no active voxels.
    std::string otherEmission;
};

/// Returns the first scalar grid called flame, flames, fire, burn, heat, temperature, and the first
/// colour grid called Cd, color, colour, albedo, in any case.
MediumGrids mediumGrids(const std::vector<VolumeEntry>& entries);

/// Whether a type is a vector of real numbers, like colours.
bool isColorType(const std::string& type);

}  // namespace deltasplat
