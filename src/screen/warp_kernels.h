// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "screen/filter_table.h"
#include "screen/warp.h"

namespace deltasplat {

/// A position on a raster from its first lattice point, in 2^-32.
struct FixedPosition {
    std::int64_t x;
    std::int64_t y;
};

/// Samples a run of picture pixels. All taps, including padding taps, must lie inside the raster.
/// @param position  of the first pixel
/// @param step      from one pixel to the next
/// @param out       RGBA
void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               FixedPosition position, FixedPosition step, int pixels, float* out);

/// Samples picture pixels at any positions, like sampleRun.
/// @param positions  [pixels]
void sampleAt(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
              const FixedPosition* positions, int pixels, float* out);

}  // namespace deltasplat
