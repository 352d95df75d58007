// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "deltasplat/optics/class_table.h"

namespace deltasplat {

/// What base plane pixels take from sheet pixels along one axis, where these lie at another
/// distance from each other: tents of weights that add up to 1.
class ScaledTaps {
  public:
    int taps = 2;  ///< that every pixel has
    /// [pixels]: the first sheet pixel of each, counted from the part's first, never decreasing; of
    /// pairs there are kSpare more, for vectors, and each is at most 1 more than the one before.
    std::vector<std::int32_t> first;
    std::vector<float> weights;  ///< [pixels][taps]
    /// [pixels + kSpare]: of two taps of pixels that lie no farther apart than those of the sheet,
    /// the first weight; else empty.
    std::vector<float> pairs;
    static constexpr std::size_t kSpare = 16;

    /// Pixels of a sheet along one axis, from the first on of a part of it.
    struct Part {
        int origin;
        int size;  ///< at least 2
    };

    /// Base pixel `firstPixel + i` lies at pixel start + scale * (firstPixel + i) of the whole
    /// sheet. Of two parts that both have what pixels read, weights have the same bits.
    void set(double start, double scale, int firstPixel, int pixels, const Part& part);
    const float* of(std::size_t pixel) const { return &weights[pixel * std::size_t(taps)]; }

  private:
    void setBetween(double start, double scale, int firstPixel, const Part& part);
};

/// What the runs of a slice have in common.
struct ScaledSlice {
    /// Sheets, one for each plane of colours, at their first pixel.
    std::array<const std::int32_t*, ClassTable::kMaxPlanes> sheets;
    std::size_t pitch;                  ///< integers from one sheet row to the next
    std::span<const glm::vec4> scales;  ///< sheet units to RGBA, of each plane; of one channel only
                                        ///< the last is used
    int rowTaps;                        ///< sheet rows that a pixel reads
    int columnTaps;                     ///< and columns
    int channels;                       ///< of sheets and layer: 4 (RGBA) or 1 (opacity)
};

/// A run of base plane pixels along one row.
struct ScaledRun {
    std::size_t place;           ///< of the first sheet pixel that is read, in integers
    const float* rowWeights;     ///< [rowTaps]
    const std::int32_t* first;   ///< [pixels]: the first sheet column of each
    const float* columnWeights;  ///< [pixels][columnTaps]
    const float* pairWeights;    ///< as ScaledTaps::pairs, or null
    int pixels;                  ///< at most kMostScaled; columns at most kMostScaledColumns
    /// For how many steps through the slice each pixel's opacity counts: `[pixels]`, and what a
    /// vector reads over the end (kStepsSpare). Of one channel null: one.
    const float* steps;
    float* layer;  ///< the layer at the run's first pixel

    int columns(int columnTaps) const { return first[pixels - 1] - first[0] + columnTaps; }
};

/// Most pixels of a run, and most sheet columns, for what lies between to stay in the first-level
/// cache.
inline constexpr int kMostScaled = 256;
inline constexpr int kMostScaledColumns = 512;

/// Reads the sum of the sheets through the runs' weights and puts it behind the layer. Each
/// pixel's light and opacity are those of so many steps: opacity a becomes 1 - (1 - a)^steps, and
/// colours grow with it. Multiplications and additions are separate and in a fixed order, so that
/// every SIMD level gives the same bits.
void overScaled(const ScaledSlice& slice, std::span<const ScaledRun> runs);

}  // namespace deltasplat
