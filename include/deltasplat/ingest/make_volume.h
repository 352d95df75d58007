// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"

namespace deltasplat {

/// How values in memory are a volume.
struct MemoryLayout {
    glm::i64vec3 dims{1};  ///< voxels along x, y and z, each 1..2^30
    /// Values from a voxel to its neighbour along x, y and z, each at least 1; empty: x is the
    /// fastest and there are no gaps, {1, dims.x, dims.x * dims.y}.
    std::optional<glm::i64vec3> strides = {};
    glm::dmat4 worldFromIndex{1.0};  ///< as Volume::worldFromIndex
    /// Voxels of this value (of float, of the nearest float) are empty, as those that are not
    /// active in a .vdb; NaN: those that are NaN. Empty: all voxels are there, as in a .raw file.
    std::optional<double> background = {};
    std::string name = "volume";
    std::string space = {};       ///< as Volume::space
    std::string lengthUnit = {};  ///< as Volume::lengthUnit
};

/// Makes a volume of values in memory, which are copied: what readVolume would make of a file of
/// them. T is one of std::uint8_t, int8_t, uint16_t, int16_t, uint32_t, int32_t, uint64_t, int64_t,
/// float and double.
/// @param values   without strides as many as there are voxels, with them at least up to the last
/// @param options  those that are not of a file format: nanValue, bits, relativeError, keepSource,
///                 keepInexact
/// @throw Error(kUsage) for a layout that cannot be meant; Error(kInput) for NaN and infinities
///        that nothing replaces; Error(kFailed) if the volume does not fit into memory
template <typename T>
Volume makeVolume(std::span<const T> values, const MemoryLayout& layout,
                  const ReadOptions& options = {}, const Listener& listener = {});

/// Writes the values of a box of voxels, x fastest, without gaps: those of Volume::source where
/// that is kept, otherwise what codes stand for (Volume::codeError says how far they are off).
/// Voxels that are not active have the volume's background, or 0 if it has none. Multi-threaded.
/// @param values  [box.voxels()]
/// @param active  [box.voxels()], 1 for active voxels and 0 for others; or empty
/// @param box  indices within 2^30 of 0
/// @throw Error(kUsage) if a span has another size
void readVoxels(const Volume& volume, const IndexBox& box, std::span<double> values,
                std::span<std::uint8_t> active = {});

}  // namespace deltasplat
