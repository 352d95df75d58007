// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace deltasplat {

/// What a voxel looks like: an index into the colours of a class table; 0 = empty.
using ClassIndex = std::uint16_t;

}  // namespace deltasplat
