// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <vector>

#include "image/warp.h"

namespace deltasplat {

/// Weights of a filter of four taps for every position between two lattice points, in steps of
/// 1/kSteps.
struct FourTapTable {
    /// Fine enough that rounding a position moves a value by less than 1/2000 of its slope.
    static constexpr int kSteps = 1024;

    std::vector<std::array<float, 4>> plain;  ///< [kSteps + 1]
    std::vector<std::array<float, 16>>
        repeated;  ///< [kSteps + 1]: each weight for the four channels
};

/// Samples a run of picture pixels whose four by four taps all lie inside the raster.
/// @param position  of the first pixel, from the raster's first lattice point
/// @param step      from one pixel to the next
/// @param out       RGBA, not yet clamped
void sampleRun(const Raster& raster, const FourTapTable& table, glm::dvec2 position,
               glm::dvec2 step, int pixels, float* out);

}  // namespace deltasplat
