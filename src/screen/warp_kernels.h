// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "screen/filter_table.h"
#include "screen/warp.h"

namespace deltasplat {

/// A position on a raster, from its first lattice point, in units of 2^-32.
struct FixedPosition {
    std::int64_t x;
    std::int64_t y;
};

/// Samples a run of picture pixels whose taps all lie inside the raster, those that only pad the
/// filter along x included.
/// @param position  of the first pixel
/// @param step      from one pixel to the next
/// @param out       RGBA
void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               FixedPosition position, FixedPosition step, int pixels, float* out);

/// Samples picture pixels at any positions, as sampleRun does.
/// @param positions  [pixels]
void sampleAt(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
              const FixedPosition* positions, int pixels, float* out);

}  // namespace deltasplat
