// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace deltasplat {

/// The table of integer weights that one voxel stamps into the sheet: the kernel integrated along
/// the line of sight. Every voxel has the same sub-pixel phase, so that one table serves the whole
/// volume: sheet pixels lie at voxel centres and at the r - 1 places between them, or half a pixel
/// beside those if the width is even.
struct Footprint {
    static constexpr std::int32_t kOne = 32767;  ///< what the weights of one phase add up to

    int resolution = 1;  ///< r: sheet pixels a voxel
    int width = 1;       ///< and height, in sheet pixels
    /// `[width][width]`, the voxel's centre in the middle. None is negative. For each of the r * r
    /// phases (places modulo r), the weights add up to exactly kOne: a constant slice gives a
    /// constant sheet.
    std::vector<std::int32_t> weights;

    /// Sheet pixels from the one at the voxel's centre, or half a pixel behind it, to the first.
    int reach() const { return width / 2; }
    /// How far behind a voxel's centre its sheet pixel lies.
    double offsetPixels() const { return width % 2 == 0 ? 0.5 : 0; }
    std::int32_t at(int x, int y) const { return weights[y * width + x]; }

    bool operator==(const Footprint&) const = default;
};

inline constexpr double kMinSigma = 0.2;
inline constexpr double kMaxSigma = 4.0;

/// Whether a voxel has a sheet pixel of its own and is seen in no other, if nothing else is asked
/// for: where there is one for each, and a voxel covers less than three pixels of the screen.
/// Nothing is sharper or faster; from there on steps would begin to show at edges.
inline bool hasOwnPixel(double pixelsPerVoxel, double resolution) {
    return resolution == 1 && pixelsPerVoxel < 3;
}

inline constexpr double kLeastSigma = 0.3;
inline constexpr double kMostSigma = 0.6;

/// Returns sigma, in voxels, where none is asked for and hasOwnPixel() is not so: kLeastSigma, the
/// sharpest, and more where a voxel would begin to show as a square, or as a step: up to kMostSigma
/// from three pixels of the screen on if it has several sheet pixels, from six on if it has one.
inline double defaultSigma(double pixelsPerVoxel, double resolution) {
    const double sigma = resolution > 1 ? 0.3 * (pixelsPerVoxel - 1) : 0.1 * pixelsPerVoxel;
    return std::clamp(sigma, kLeastSigma, kMostSigma);
}

/// Makes the Gaussian footprint with covariance sigma^2 (I + d d^T) in slice units: a round kernel
/// seen along the line of sight.
/// @param sigmaVoxels    kMinSigma / perVoxel..kMaxSigma
/// @param shiftPerSlice  d, |d| <= 1 in each component, in the table's (x, y)
/// @param resolution     r, at least 1
/// @param width          pixels, r..kMaxFootprintWidth; empty: the smallest odd number that leaves
/// out less than kFootprintTail of the weight
/// @param perVoxel       how many footprints a voxel has along each axis, each with r pixels of its
/// own
/// @throw Error(kUsage) if sigma or width is out of range
Footprint makeFootprint(double sigmaVoxels, glm::dvec2 shiftPerSlice, int resolution,
                        std::optional<int> width = {}, int perVoxel = 1);
inline constexpr double kFootprintTail = 0.002;
inline constexpr int kMaxFootprintWidth = 1024;

}  // namespace deltasplat
