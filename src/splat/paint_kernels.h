// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "deltasplat/optics/class_table.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// Writes colours of voxels of a block where two rows lie together (PairedRow). Others are written
/// as well, so that all must be what they are now.
/// @param voxels   a mask word, bit 8 * u + v: those that may have changed
/// @param classes  [64]: of all voxels of the block
/// @param plane    the block's first voxel, `[pair of rows][pitch]`
void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const ClassTable::Color* colors,
                std::int16_t* plane, std::size_t pitch);
/// The same of opacity alone.
/// @param opacities  [classes]
void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const std::int16_t* opacities,
                std::int16_t* plane, std::size_t pitch);

}  // namespace deltasplat
