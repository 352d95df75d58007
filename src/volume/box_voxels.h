// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Returns how many voxels a box has; of boxes that have more than 64 bits hold, 2^63.
inline std::uint64_t voxelsOf(const IndexBox& box) {
    const glm::ivec3 d = box.dims();
    constexpr double kMost = 0x1p63;
    const double voxels = double(d.x) * double(d.y) * double(d.z);
    return voxels < kMost ? std::uint64_t(d.x) * std::uint64_t(d.y) * std::uint64_t(d.z)
                          : std::uint64_t(kMost);
}

}  // namespace deltasplat
