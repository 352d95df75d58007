// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "picture_view.h"

namespace deltasplat {

/// Returns a number of what the slabs of a view are rendered from, its voxels and their colours:
/// others have another one, but for chance. Of lights it knows nothing. Deterministic;
/// multi-threaded.
/// @param words  digestOfWords of the view, or of the whole that it shows some slices of
std::uint64_t digestOf(const PictureView& view, std::uint64_t words);

/// Returns such a number of a view's voxels alone.
std::uint64_t digestOfWords(const PictureView& view);

}  // namespace deltasplat
