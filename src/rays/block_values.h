// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "rays/ray_volume.h"

namespace deltasplat {

/// A word for each slice of a block: bit 8 * u + v is set where the voxel is active.
using ActiveWords = std::array<std::uint64_t, 8>;

/// Reads the values of a block, `volume.empty` where a voxel is not active. Returns which are.
ActiveWords readActiveValues(const RayVolume& volume, const CodeBlock& block,
                             const BlockPlace& place);

}  // namespace deltasplat
