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

/// Weights of sheet pixels for base pixels of another spacing along one axis: tents of sum 1.
class ScaledTaps {
  public:
    int taps = 2;  ///< per pixel
    /// [pixels]: first sheet pixel, counted from the part's first, never decreasing. With pairs:
    /// kSpare more, for vectors, and each at most 1 more than the one before.
    std::vector<std::int32_t> first;
    std::vector<float> weights;  ///< [pixels][taps]
    /// [pixels + kSpare]: first of two weights, if base pixels are no farther apart; else empty.
    std::vector<float> pairs;
    static constexpr std::size_t kSpare = 16;

    /// Sheet pixels of a part along one axis.
    struct Part {
        int origin;
        int size;  ///< at least 2
    };

    /// Base pixel `firstPixel + i` lies at pixel start + scale * (firstPixel + i) of the whole
    /// sheet. Weights have the same bits in every part that has the read pixels.
    void set(double start, double scale, int firstPixel, int pixels, const Part& part);
    const float* of(std::size_t pixel) const { return &weights[pixel * std::size_t(taps)]; }

  private:
    void setBetween(double start, double scale, int firstPixel, const Part& part);
};

struct ScaledSlice {
    /// Sheets per plane of colours, at their first pixel.
    std::array<const std::int32_t*, ClassTable::kMaxPlanes> sheets;
    std::size_t pitch;  ///< integers from one sheet row to the next
    std::span<const glm::vec4>
        scales;      ///< sheet units to RGBA, per plane; a single channel uses the last
    int rowTaps;     ///< sheet rows per pixel
    int columnTaps;  ///< and columns per pixel
    int channels;    ///< of sheets and layer: 4 (RGBA) or 1 (opacity)
};

/// A run of base plane pixels along one row.
struct ScaledRun {
    std::size_t place;           ///< of the first read sheet pixel, in integers
    const float* rowWeights;     ///< [rowTaps]
    const std::int32_t* first;   ///< [pixels]: first sheet column of each
    const float* columnWeights;  ///< [pixels][columnTaps]
    const float* pairWeights;    ///< as ScaledTaps::pairs, or null
    int pixels;                  ///< at most kMostScaled; columns at most kMostScaledColumns
    /// Steps through the slice per pixel: `[pixels]`, and kStepsSpare. For one channel null: one.
    const float* steps;
    float* layer;  ///< the layer at the run's first pixel

    int columns(int columnTaps) const { return first[pixels - 1] - first[0] + columnTaps; }
};

/// Most pixels and sheet columns of a run, to stay in the first-level cache.
inline constexpr int kMostScaled = 256;
inline constexpr int kMostScaledColumns = 512;

/// Reads the sum of the sheets with the runs' weights and puts it behind the layer. Light and
/// opacity are those of `steps`: opacity a becomes 1 - (1 - a)^steps, and colours grow with it.
/// Multiplications and additions are separate and in order: every SIMD level gives the same bits.
void overScaled(const ScaledSlice& slice, std::span<const ScaledRun> runs);

}  // namespace deltasplat
