// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>

#include "deltasplat/progress.h"
#include "deltasplat/synth/analytic_volume.h"

namespace deltasplat {

struct AnalyticFileOptions {
    glm::ivec3 dims{64};  ///< voxels along x, y, z, each at least 1
    std::string type;  ///< .raw: uint8, uint16 or float32 (empty: uint8); .vdb: always a float grid
    glm::dvec3 spacing{1.0};  ///< world units per voxel
    /// Samples along each axis, 1..16, that a voxel is the mean of, as in a scanner; 1: centre.
    int samples = 1;
};

/// Samples a volume at voxel centres, position = (2 * index + 1) / dims - 1 along each axis, or
/// evenly within voxels, and writes it to
/// - `.raw`: little endian; 0..1 becomes 0..255 or 0..65535, rounded to nearest. Other grids and
///   colours are left out, with a warning
/// - `.vdb`: fog volumes with background 0: "density", whose zeros are inactive, other grids,
///   inactive up to their threshold, then colours, "Cd" of `vec3s`, active where the density is
///
/// Needs memory for a few slices (.raw) or for the active voxels (.vdb).
/// @throw Error(kUsage) for another extension, type or dims; Error(kFailed) for more than memory
///        holds; Error(kOutput) if the file cannot be written
void writeAnalytic(const AnalyticVolume& volume, const std::filesystem::path& file,
                   const AnalyticFileOptions& options, const Listener& listener = {});

}  // namespace deltasplat
