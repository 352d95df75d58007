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

/// How values lie in memory and in the world.
struct MemoryLayout {
    glm::i64vec3 dims{1};  ///< voxels along x, y and z, each 1..2^30
    /// Steps in values to the next voxel along x, y and z, each at least 1; empty: no gaps, x
    /// fastest, {1, dims.x, dims.x * dims.y}.
    std::optional<glm::i64vec3> strides = {};
    glm::dmat4 worldFromIndex{1.0};  ///< as Volume::worldFromIndex
    /// Voxels of this value (in float data, of the nearest float) are empty, like inactive ones of
    /// a .vdb; NaN: NaN voxels are. Empty: all voxels are active, as in a .raw file.
    std::optional<double> background = {};
    std::string name = "volume";
    std::string space = {};       ///< as Volume::space
    std::string lengthUnit = {};  ///< as Volume::lengthUnit
};

/// Makes a volume of copied values, as readVolume would from a file. T is one of std::uint8_t,
/// int8_t, uint16_t, int16_t, uint32_t, int32_t, uint64_t, int64_t, float and double.
/// @param values   without strides one per voxel, with strides at least up to the last voxel
/// @param options  those of no file format: nanValue, bits, relativeError, keepSource, keepInexact
/// @throw Error(kUsage) for an impossible layout; Error(kInput) for NaN and infinities without a
///        replacement; Error(kFailed) if the volume does not fit into memory
template <typename T>
Volume makeVolume(std::span<const T> values, const MemoryLayout& layout,
                  const ReadOptions& options = {}, const Listener& listener = {});

/// Writes the values of a box of voxels, x fastest, without gaps: from Volume::source if it is
/// kept, otherwise from the codes (error: Volume::codeError). Inactive voxels get the volume's
/// background, or 0 if it has none. Multi-threaded.
/// @param values  [box.voxels()]
/// @param active  [box.voxels()], 1 for active voxels and 0 for others; or empty
/// @param box  indices within 2^30 of 0
/// @throw Error(kUsage) if a span has another size
void readVoxels(const Volume& volume, const IndexBox& box, std::span<double> values,
                std::span<std::uint8_t> active = {});

}  // namespace deltasplat
