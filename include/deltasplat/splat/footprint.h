// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace deltasplat {

/// Integer weights that one voxel stamps into the sheet: the kernel integrated along the line of
/// sight. Every voxel has the same sub-pixel phase, so one table serves all: sheet pixels lie at
/// voxel centres and at r - 1 places between, or half a pixel beside them for an even width.
struct Footprint {
    static constexpr std::int32_t kOne = 32767;  ///< sum of the weights of one phase

    int resolution = 1;  ///< r: sheet pixels per voxel
    int width = 1;       ///< and height, in sheet pixels
    /// `[width][width]`, the voxel's centre in the middle, >= 0. The weights of each of the r * r
    /// phases (places modulo r) add up to exactly kOne: a constant slice gives a constant sheet.
    std::vector<std::int32_t> weights;

    /// Sheet pixels from the first to the pixel at the voxel's centre, or half a pixel behind it.
    int reach() const { return width / 2; }
    /// Distance from a voxel's centre to its sheet pixel behind.
    double offsetPixels() const { return width % 2 == 0 ? 0.5 : 0; }
    std::int32_t at(int x, int y) const { return weights[y * width + x]; }

    bool operator==(const Footprint&) const = default;
};

inline constexpr double kMinSigma = 0.2;
inline constexpr double kMaxSigma = 4.0;

/// Whether by default a voxel is seen in one sheet pixel of its own: at one pixel per voxel and
/// less than three screen pixels. Nothing is sharper or faster; larger voxels show steps at edges.
inline bool hasOwnPixel(double pixelsPerVoxel, double resolution) {
    return resolution == 1 && pixelsPerVoxel < 3;
}

inline constexpr double kLeastSigma = 0.3;
inline constexpr double kMostSigma = 0.6;

/// Returns the default sigma, in voxels, if hasOwnPixel() is false: kLeastSigma, the sharpest, or
/// more where voxels would show as squares or steps. It reaches kMostSigma at three screen pixels
/// per voxel with several sheet pixels per voxel, at six with one.
inline double defaultSigma(double pixelsPerVoxel, double resolution) {
    const double sigma = resolution > 1 ? 0.3 * (pixelsPerVoxel - 1) : 0.1 * pixelsPerVoxel;
    return std::clamp(sigma, kLeastSigma, kMostSigma);
}

/// Makes the Gaussian footprint with covariance sigma^2 (I + d d^T), round, in slice units.
/// @param sigmaVoxels    kMinSigma / perVoxel..kMaxSigma
/// @param shiftPerSlice  d, |d| <= 1 in each component, in the table's (x, y)
/// @param resolution     r, at least 1
/// @param width          pixels, r..kMaxFootprintWidth; empty: the smallest odd width that omits
///                       less than kFootprintTail of the weight
/// @param perVoxel       footprints per voxel along each axis, each with r pixels of its own
/// @throw Error(kUsage) if sigma or width is out of range
Footprint makeFootprint(double sigmaVoxels, glm::dvec2 shiftPerSlice, int resolution,
                        std::optional<int> width = {}, int perVoxel = 1);
inline constexpr double kFootprintTail = 0.002;
inline constexpr int kMaxFootprintWidth = 1024;

}  // namespace deltasplat
