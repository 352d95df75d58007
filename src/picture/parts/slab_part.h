// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "picture/picture_view.h"

namespace deltasplat {

/// Returns a number of what the slabs of a view are rendered from, its voxels and their colours:
/// others have another one, but for chance. Of lights it knows nothing. Deterministic;
/// multi-threaded.
std::uint64_t digestOf(const PictureView& view);

}  // namespace deltasplat
