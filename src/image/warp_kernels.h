// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include "image/filter_table.h"
#include "image/warp.h"

namespace deltasplat {

/// Samples a run of picture pixels whose taps all lie inside the raster, those that only pad the
/// filter along x included.
/// @param position  of the first pixel, from the raster's first lattice point
/// @param step      from one pixel to the next
/// @param out       RGBA, not yet clamped
void sampleRun(const Raster& raster, const FilterTable& filterX, const FilterTable& filterY,
               glm::dvec2 position, glm::dvec2 step, int pixels, float* out);

}  // namespace deltasplat
