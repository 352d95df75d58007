// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "deltasplat/optics/class_table.h"
#include "words/packed_deltas.h"

namespace deltasplat {

/// Writes colours of a block's voxels where two rows lie together (PairedRow). Unchanged voxels are
/// rewritten, so all `classes` must be current.
/// @param voxels   a mask word, bit 8 * u + v: voxels that may have changed
/// @param classes  [64], of all voxels of the block
/// @param plane    the block's first voxel, `[pair of rows][pitch]`
void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const ClassTable::Color* colors,
                std::int16_t* plane, std::size_t pitch);
/// Paints opacity only.
/// @param opacities  [classes]
void paintPairs(std::uint64_t voxels, const ClassIndex* classes, const std::int16_t* opacities,
                std::int16_t* plane, std::size_t pitch);

}  // namespace deltasplat
