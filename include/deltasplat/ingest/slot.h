// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// A voxel's index into tables: 0 = empty (inactive or invisible), else code + 1. Delta grids in
/// files have slots beyond kSlotCount for inactive voxels with values of their own.
using Slot = std::int32_t;
inline constexpr Slot kEmptySlot = 0;
inline constexpr int kSlotCount = kCodeCount + 1;

/// Returns the volume axes (0 = x, 1 = y, 2 = z) of (slice, u, v): cyclic, to keep handedness.
inline glm::ivec3 sliceOrder(int sliceAxis) {
    return {sliceAxis, (sliceAxis + 1) % 3, (sliceAxis + 2) % 3};
}

template <typename Vector>
glm::ivec3 toSliceOrder(const Vector& v, int sliceAxis) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    return {v[order[0]], v[order[1]], v[order[2]]};
}

/// Returns the components of `v`, given in (slice, u, v) order, in x, y, z order.
inline glm::ivec3 fromSliceOrder(const glm::ivec3& v, int sliceAxis) {
    const glm::ivec3 order = sliceOrder(sliceAxis);
    glm::ivec3 xyz;
    for (int axis = 0; axis < 3; ++axis) xyz[order[axis]] = v[axis];
    return xyz;
}

}  // namespace deltasplat
